// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <taut/lattice/chain.hpp>
#include <taut/network/combination.hpp>
#include <taut/scene/cloth.hpp>

#include "analysis.hpp"

// The scenes that the stability tests judge.

namespace taut_test {

Scene chain_scene(bool single, int dim, const taut::ChainOptions& options);
Scene cloth_scene(const taut::ClothOptions& options, bool single = false);
/// The same scene, its springs changed.
Scene with_springs(const Scene& scene, const std::function<void(AnySpring&)>& change);
/// With an axial damper of `ratio`·stiffness, N·s/m, on every spring.
Scene with_dampers(const Scene& scene, double ratio);
/// With springs of rest length 0, which are linear: their K is the same at every pose.
Scene at_zero_length(const Scene& scene);
/// Every coordinate multiplied by `factor`, then moved by up to `noise`.
AnyState deformed(const Scene& scene, double factor, double noise, std::uint32_t seed);

/// A scene with its damping in a pose small enough for dense eigenvalues, ready to be judged.
struct StabilityCase {
    std::string text;
    Scene scene;
    AnyState state;
    Exact exact;
    Analysis analysis;
};
/// Scenes of all dimensions, undamped; or with every damping.
std::vector<StabilityCase> stability_cases(bool single, bool with_damping);

/// Kinds of damping; parts in units of the scene's frequencies.
struct Damping {
    const char* text;
    double dampers, d0, alpha;
};
inline constexpr Damping dampings[] = {{"no damping", 0, 0, 0},
                                       {"d0", 0, 0.25, 0},
                                       {"strong d0", 0, 6, 0},
                                       {"alpha", 0, 0, 0.1},
                                       {"strong alpha", 0, 0, 5},
                                       {"d0 and alpha", 0, 0.2, 0.3},
                                       {"dampers", 0.2, 0, 0},
                                       {"dampers and d0", 0.5, 0.3, 0},
                                       {"dampers, d0 and alpha", 2, 0.1, 0.2}};

struct WildOptions {
    Index most_particles = 6;
    double decades = 3;   ///< masses and stiffnesses spread over twice as many
    bool damping = true;  ///< dampers and Rayleigh, at random
    bool pins = true;
};
double over_decades(Random& random, double decades);
/// A small random graph of Hookean springs whose masses and stiffnesses lie orders of magnitude
/// apart, some springs compressed, some without length, with random pins, dampers and Rayleigh
/// damping. Never without a free particle.
Scene wild_scene(Random& random, const Kind& kind, const WildOptions& options = {});

/// Weights of M, K and D of either sign, some of them zero.
taut::Combination wild_combination(Random& random);
/// The sum in long double.
RealMatrix exact_sum(const Exact& e, const taut::Combination& c);
/// Eigenvalues of M⁻¹S, ascending.
RealVector exact_eigenvalues(const Exact& e, const taut::Combination& c);

Eigen::VectorXd random_vector(Random& random, Index n);
/// A random symmetric matrix with the given eigenvalues.
Eigen::MatrixXd with_spectrum(Random& random, const Eigen::VectorXd& spectrum);
/// Random entries with about `degree` neighbours each, diagonally dominant by a little.
Eigen::MatrixXd random_graph(Random& random, Index n, Index degree);

template <class Scalar = double, class Dense>
Eigen::SparseMatrix<Scalar> sparse(const Dense& A) {
    return A.template cast<Scalar>().eval().sparseView();
}

}  // namespace taut_test
