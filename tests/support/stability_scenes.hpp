// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <taut/lattice/chain.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/stability/stability.hpp>
#include <utility>

#include "referee.hpp"
#include "zero_rest_length.hpp"

// The scenes that the stability tests judge.

namespace taut_test {

/// The same system with an axial damper of `ratio`·stiffness, N·s/m, on every spring.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> with_dampers(const taut::SpringSystem<Scalar, Dim>& system,
                                             double ratio) {
    using System = taut::SpringSystem<Scalar, Dim>;
    return taut::with_springs<System>(system, [&](System& copy, auto spring, Index) {
        spring.damping =
            static_cast<Scalar>(ratio * static_cast<double>(spring.parameters.stiffness));
        copy.add_spring(spring);
    });
}

/// Every coordinate multiplied by `factor`, then moved by up to `noise`.
template <class System>
typename System::State deformed(const System& system, double factor, double noise,
                                std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    auto state = system.initial_state();
    state.x *= static_cast<Scalar>(factor);
    state.x += random.points<Scalar, System::Dim>(system.size(), -noise, noise);
    return state;
}

/// visit(name, system, state) for scenes of all dimensions, small enough for dense eigenvalues.
template <class Scalar, class Visit>
void for_each_scene(Visit&& visit) {
    using taut::ChainEnds;
    const auto at_rest = [&](const char* name, const auto& system) {
        visit(std::string(name), system, system.initial_state());
    };
    taut::ChainOptions chain;
    chain.masses = 5;
    chain.mass = 0.1;
    chain.stiffness = 300;
    const auto ends = [&chain](ChainEnds e) {
        chain.ends = e;
        return chain;
    };
    at_rest("chain 1d, fixed-fixed", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_fixed)));
    at_rest("chain 1d, fixed-free", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_free)));
    at_rest("chain 1d, free-free", taut::chain<Scalar, 1>(ends(ChainEnds::free_free)));
    at_rest("ring 1d", taut::chain<Scalar, 1>(ends(ChainEnds::ring)));
    at_rest("ring 2d", taut::chain<Scalar, 2>(ends(ChainEnds::ring)));
    at_rest("chain 3d, fixed-free", taut::chain<Scalar, 3>(ends(ChainEnds::fixed_free)));
    const auto row = taut::chain<Scalar, 2>(ends(ChainEnds::fixed_fixed));
    visit("chain 2d, stretched", row, deformed(row, 1.5, 0.02, 1));
    visit("chain 2d, compressed", row, deformed(row, 0.8, 0.02, 2));
    at_rest("chain 3d, zero rest length",
            at_zero_rest_length(taut::chain<Scalar, 3>(ends(ChainEnds::fixed_fixed))));
    chain.spacing = 0;
    at_rest("chain 1d, all in one point", taut::chain<Scalar, 1>(ends(ChainEnds::fixed_free)));
    at_rest("chain 2d, all in one point", taut::chain<Scalar, 2>(ends(ChainEnds::free_free)));
    chain.spacing = 1;
    chain.stiffness = 0;
    at_rest("chain 2d, no stiffness",
            at_zero_rest_length(taut::chain<Scalar, 2>(ends(ChainEnds::fixed_free))));

    taut::SpringSystem<Scalar, 3> alone;
    alone.add_particle({1, 2, 3}, Scalar(0.5));
    at_rest("a single particle", alone);
    taut::SpringSystem<Scalar, 1> one;
    one.add_particle(Eigen::Matrix<Scalar, 1, 1>(Scalar(0)), Scalar(1));
    one.add_particle(Eigen::Matrix<Scalar, 1, 1>(Scalar(1)), Scalar(0.01));
    one.add_spring(0, 1, Scalar(1e4));
    one.pin(0);
    at_rest("one mass on one spring", one);
    auto held = one;
    held.pin(1);
    at_rest("everything pinned", held);

    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = 3;
    const auto grid = taut::hanging_cloth<Scalar>(cloth);
    visit("cloth, flat", grid, grid.initial_state());
    visit("cloth, stretched", grid, deformed(grid, 1.1, 0.01, 3));
    visit("cloth, compressed", grid, deformed(grid, 0.9, 0.01, 4));
    visit("cloth, crumpled", grid, deformed(grid, 0.3, 0.3, 5));
    cloth.pin_corners = false;
    cloth.rows = 2;
    const auto flying = taut::hanging_cloth<Scalar>(cloth);
    visit("cloth, free-flying", flying, flying.initial_state());
    visit("cloth, free-flying and wrinkled", flying, deformed(flying, 1.02, 0.05, 6));
    cloth.diagonals = false;
    cloth.pin_corners = true;
    const auto linear = at_zero_rest_length(taut::hanging_cloth<Scalar>(cloth));
    visit("grid of zero rest length", linear, linear.initial_state());
}

/// visit(name, damped system) for each kind of damping; `omega` is the scale of its frequencies.
template <class System, class Visit>
void for_each_damping(const System& system, double omega, Visit&& visit) {
    const auto rayleigh = [&](const char* name, System copy, double d0, double alpha) {
        copy.set_rayleigh({d0 * omega, alpha / omega});
        visit(std::string(name), copy);
    };
    rayleigh("no damping", system, 0, 0);
    rayleigh("d0", system, 0.25, 0);
    rayleigh("strong d0", system, 6, 0);
    rayleigh("alpha", system, 0, 0.1);
    rayleigh("strong alpha", system, 0, 5);
    rayleigh("d0 and alpha", system, 0.2, 0.3);
    rayleigh("dampers", with_dampers(system, 0.2 / omega), 0, 0);
    rayleigh("dampers and d0", with_dampers(system, 0.5 / omega), 0.3, 0);
    rayleigh("dampers, d0 and alpha", with_dampers(system, 2 / omega), 0.1, 0.2);
}

/// A scene with its damping, ready to be judged.
template <class Scalar>
struct StabilityCase {
    std::string text;
    Exact exact;
    taut::Stability<Scalar> stability;
    std::uint64_t revision;
    std::optional<taut::LinearSystem<Scalar>>
        linear;  ///< without load; none if everything is pinned

    Multipliers multipliers() const { return Multipliers(exact); }
};

template <class Scalar, class System>
StabilityCase<Scalar> stability_case(std::string text, const System& system,
                                     const typename System::State& state) {
    StabilityCase<Scalar> c{std::move(text),
                            exact_matrices(system, state.x),
                            {system, state},
                            system.revision(),
                            std::nullopt};
    if (system.pinned_count() < system.size()) {
        const auto linear = taut::linearize(system, state);
        c.linear.emplace(linear.mass(), linear.damping(), linear.stiffness());
    }
    return c;
}

/// Every scene, undamped; or with every damping.
template <class Scalar>
std::vector<StabilityCase<Scalar>> stability_cases(bool with_damping);
extern template std::vector<StabilityCase<float>> stability_cases(bool);
extern template std::vector<StabilityCase<double>> stability_cases(bool);

/// A random symmetric matrix with the given eigenvalues.
Eigen::MatrixXd with_spectrum(Random& random, const Eigen::VectorXd& spectrum);

template <class Scalar = double, class Dense>
Eigen::SparseMatrix<Scalar> sparse(const Dense& A) {
    return A.template cast<Scalar>().eval().sparseView();
}

}  // namespace taut_test
