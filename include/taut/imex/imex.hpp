// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "../core/buffer.hpp"
#include "../integrator/detail/explicit_steps.hpp"
#include "../solver/interleaved_llt.hpp"
#include "../proof/detail/symplectic_limit.hpp"
#include "../proof/pencil.hpp"
#include "detail/run_corrected.hpp"
#include "detail/spring_shares.hpp"

namespace taut {

/// Of ImexEuler.
struct ImexOptions {
    /// h₀, s, finite and > 0: the step that the inertia is made for. Shorter ones have it, too.
    double step = 0;
    /// The share of implicitness, 0 … 1, of a spring by its index, whenever shares are made anew;
    /// empty: 1 for the stiffest springs, as few as the bounds need to prove h₀, 0 for the others.
    std::function<double(Index)> share;
    /// As ExplicitOptions::threads.
    int threads = 1;
};

/// EnergyStableEuler with more inertia, spring by spring [T41]: a stiff hem is implicit, the cloth
/// beside it explicit. A spring of stiffness bound k, damping c (that of Rayleigh's αk counted) and
/// share s adds its graph Laplacian L_e to the masses, at one step h₀ for all steps:
///
///     A = M + Σ s(h₀²k + ½h₀c) L_e,   A(v⁺ − v) = h(f − D v + F),   x⁺ = x + h v⁺ ,
///
/// f as [T42] has it, rows and columns of pins left out of A. For every h ≤ limit().certified, and
/// steps may differ, H = ½vᵀAv + U rises by no more than the work that EnergyStableEuler's does,
/// and by rounding. One factor of the particles that implicit springs touch serves all steps and
/// coordinates. Momentum is kept. Implicit springs are damped as by implicit Euler and resist
/// rotation as if they were heavier.
///
/// Made in the constructor, and anew by itself when the system's revision() moves on: H moves, too.
template <class System>
class ImexEuler {
    static_assert((require_system<System>(), true));
    static_assert(network_detail::is_spring_system_v<System>,
                  "taut::ImexEuler: needs the springs of a SpringSystem");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = ImexOptions;
    static constexpr int order = 1;

    /// Keeps a reference: the system must outlive the stepper. Options out of range go to fail().
    ImexEuler(const System& system, const Options& options)
        : system_(&system), options_(options), steps_({options.threads}) {
        require_positive("ImexEuler", "step", options.step);
        (void)renew();
    }
    ImexEuler(const System&&, const Options&) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView; beyond limit() too,
    /// where energy may rise. On failure the state is as it was before; the report says so where A
    /// could not be factorised.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);
    /// Makes the inertia anew if the system was edited, as step() does by itself. masses_lost: h₀
    /// is so large that rounding loses a mass beside the springs on it.
    Report renew();

    /// Up to which step no energy is gained: h₀, or less where the shares given or drag allow only
    /// that; nothing is refuted. Void once the system is edited, until renew().
    const StepLimit<Scalar>& limit() const { return limit_; }
    /// The share of spring s. Unchecked: 0 ≤ s < spring_count() when last made.
    double share(Index s) const { return links_[static_cast<std::size_t>(s)].share; }
    /// Springs with a share.
    Index implicit_springs() const {
        return std::count_if(links_.begin(), links_.end(),
                             [](const auto& link) { return link.share > 0; });
    }
    /// Particles in the factor.
    Index touched() const { return static_cast<Index>(particles_.size()); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factorizations_; }
    /// ½vᵀ(A − M)v over the free particles, J: H is this and SpringSystem::energy. Of the system as
    /// it was when the inertia was last made.
    double added_kinetic(const State& state) const;

private:
    using Real = TangentReal<Scalar>;
    static constexpr int Dim = System::Dim;
    using Rows = typename InterleavedLLT<Real>::template Block<Dim>;

    void find_shares();
    Report factorize();
    /// a ← A⁻¹M a, of the touched particles.
    template <class Accelerations>
    void correct(const Accelerations& a);

    const System* system_;
    Options options_;
    integrator_detail::ExplicitSteps<System> steps_;
    std::vector<imex_detail::Link> links_;
    Buffer<Index> particles_;  // of the rows
    Buffer<int> row_;          // of each particle, or −1
    InterleavedLLT<Real> solver_;
    Rows rows_;  // kg·m/s²
    StepLimit<Scalar> limit_;
    Report made_{Status::not_converged};  // until it is made
    std::int64_t factorizations_ = 0;
};

template <class System>
Report ImexEuler<System>::renew() {
    if (made_.status != Status::not_converged && limit_.revision == system_->revision())
        return made_;
    find_shares();
    made_ = factorize();
    if (!made_) limit_.certified = 0;
    return made_;
}

template <class System>
void ImexEuler<System>::find_shares() {
    imex_detail::SpringShares shares(*system_, options_.step);
    const std::size_t springs = shares.links().size();
    for (std::size_t s = 0; options_.share && s < springs; ++s) {
        const double share = options_.share(static_cast<Index>(s));
        if (!(share >= 0 && share <= 1 && detail::is_finite(share)))
            fail("ImexEuler: share of spring ", s, " is ", share, "; it must be in [0, 1]");
        shares.set(s, share);
    }
    if (!options_.share) shares.choose();
    double certified = options_.step;
    if (!shares.proved()) {
        std::vector<double> parts;
        for (const auto& link : shares.links()) parts.push_back(link.share);
        const auto laplacian = Pencil::any_pose(*system_, Pencil::Damping::half);
        const auto rest = laplacian.explicit_part(parts);
        // Half of it: as energy_limit.
        const double half = proof_detail::certified_symplectic(rest).h / 2;
        certified = laplacian.lost().empty() ? (std::min)(certified, half) : 0;
    }
    links_ = shares.links();
    limit_ = {};
    limit_.revision = system_->revision();
    limit_.refuted = std::numeric_limits<Scalar>::infinity();
    limit_.certified = certified == options_.step ? static_cast<Scalar>(certified)
                                                  : proof_detail::round_down<Scalar>(certified);
}

template <class System>
Report ImexEuler<System>::factorize() {
    particles_.clear();
    row_.assign(system_->size(), -1);
    std::vector<Eigen::Triplet<Real>> entries;
    const auto row_of = [&](Index i) {
        int& row = row_[i];
        if (row < 0 && !system_->is_pinned(i)) {
            row = static_cast<int>(particles_.size());
            particles_.push_back(i);
            entries.emplace_back(row, row, static_cast<Real>(system_->mass(i)));
        }
        return row;
    };
    for (const auto& link : links_) {
        const auto inertia = static_cast<Real>(link.share * link.inertia);
        if (!(inertia > 0)) continue;
        const int a = row_of(link.a), b = row_of(link.b);
        for (const int row : {a, b}) {
            if (row >= 0) entries.emplace_back(row, row, inertia);
        }
        if (a < 0 || b < 0) continue;
        entries.emplace_back(a, b, -inertia);
        entries.emplace_back(b, a, -inertia);
    }
    rows_.resize(touched(), Dim);
    if (touched() == 0) return {};
    SparseMatrix<Real> A(touched(), touched());
    A.setFromTriplets(entries.begin(), entries.end());
    constexpr Real lost = 64 * std::numeric_limits<Real>::epsilon();
    for (Index j = 0; j < touched(); ++j) {
        if (!(lost * A.coeff(j, j) < static_cast<Real>(system_->mass(particles_[j]))))
            return {Status::masses_lost, 0, 0, particles_[j]};
    }
    solver_.analyzePattern(A);
    solver_.factorize(A);
    ++factorizations_;
    if (solver_.info() != Eigen::Success) return {Status::not_positive_definite};
    return {};
}

template <class System>
template <class AnyState>
Report ImexEuler<System>::step(AnyState& state, Scalar h, Index count) {
    const Report checked = integrator_detail::StepLoop<State>::examine(*system_, state, h);
    if (!checked || count <= 0) return checked;
    if (const Report made = renew(); !made) return made;
    if (touched() == 0)
        return steps_.run_ahead(*system_, state, h, count, integrator_detail::KickAndDrift{});
    const auto correction = [&](const auto& a, const auto&) { correct(a); };
    return steps_.template run_corrected<true>(*system_, state, h, count, correction);
}

template <class System>
template <class Accelerations>
void ImexEuler<System>::correct(const Accelerations& a) {
    for (Index j = 0; j < touched(); ++j) {
        const Index i = particles_[j];
        rows_.row(j) = static_cast<Real>(system_->mass(i)) * a(i).transpose().template cast<Real>();
    }
    const auto solution = solver_.solve(rows_);
    for (Index j = 0; j < touched(); ++j)
        a.set(particles_[j], solution.row(j).transpose().template cast<Scalar>());
}

template <class System>
double ImexEuler<System>::added_kinetic(const State& state) const {
    double sum = 0;
    for (const auto& link : links_) {
        if (!(link.share > 0)) continue;
        Eigen::Matrix<double, Dim, 1> between = Eigen::Matrix<double, Dim, 1>::Zero();
        if (row_[link.b] >= 0) between += state.v.col(link.b).template cast<double>();
        if (row_[link.a] >= 0) between -= state.v.col(link.a).template cast<double>();
        sum += link.share * link.inertia / 2 * between.squaredNorm();
    }
    return sum;
}

}  // namespace taut
