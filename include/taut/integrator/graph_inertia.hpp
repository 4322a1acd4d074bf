// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../method/graph_inertia.hpp"
#include "../solver/interleaved_llt.hpp"
#include "../stability/graph_shares.hpp"
#include "detail/explicit_steps.hpp"
#include "detail/graph_matrix.hpp"
#include "detail/last_state.hpp"
#include "graph_inertia_options.hpp"

namespace taut {

/// Symplectic Euler with more inertia, spring by spring [T33]: each spring has a share s of
/// implicitness, and the masses grow by a constant matrix,
///
///     M̃ = M + (1/θ) Σ s(h c/2 + h² k/4) L_e,   M̃(v⁺ − v) = h f(x, v),   x⁺ = x + h v⁺ ,
///
/// L_e being the graph Laplacian of one spring, k its stiffness bound, c its damping bound. The
/// shares are the least that make h safe at every pose: a stiff hem is implicit, the cloth beside
/// it explicit. One n × n factor of the particles that such springs touch serves all coordinates
/// and all steps. There is no numerical damping; linear momentum is kept. What it costs in
/// accuracy: implicit springs resist rotation and folding as if they were heavier.
///
/// `dissipation` δ adds implicit damping D_i = (δ/θ) Σ s ½hk L_e, taken at the mean of v and v⁺; at
/// δ = 1 all springs are implicit and the energy cannot rise [T35].
///
/// A factor made for a step serves every shorter one. It is made anew when the step grows, when the
/// system's revision() moves on, or on prepare().
/// @tparam Solver  for symmetric n × n matrices, solve() taking n × Dim with contiguous rows
template <class System,
          class Solver = InterleavedLLT<typename System::Scalar, Eigen::NaturalOrdering<int>>>
class GraphInertia {
    static_assert(model_detail::is_spring_system_v<std::decay_t<System>>,
                  "taut::GraphInertia: needs a SpringSystem; matrices have no springs to share");

public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = GraphInertiaOptions;
    static constexpr Method method = Method::graph_inertia;
    static constexpr int order = method::GraphInertia::order;

    static_assert((require_solver<Solver, Scalar>(), true));

    /// Keeps a reference: the system must outlive the stepper.
    explicit GraphInertia(const System& system, const Options& options = {})
        : system_(&system), options_(options), steps_(ExplicitOptions{options.threads, {}}) {
        options.require_valid();
    }
    explicit GraphInertia(const System&&, const Options& = {}) = delete;

    /// Takes `count` steps of h, s, finite and > 0, of a State or StateView. On failure the state
    /// is as it was before; the report says so where h is too large for shares, for the masses or
    /// for the memory.
    template <class AnyState>
    Report step(AnyState& state, Scalar h, Index count = 1);

    /// Chooses shares for steps of h, s, and factorises.
    Report prepare(Scalar h);
    /// The shares in force; of step 0 before the first step.
    const GraphShares& shares() const { return shares_; }
    /// What the stepper was made with.
    const Options& options() const { return options_; }
    /// Particles in the factor.
    Index touched() const { return matrix_.size(); }
    /// Factorisations so far.
    std::int64_t factorizations() const { return factorizations_; }
    /// ½vᵀ(M̃ − M)v, J: what the added inertia holds.
    double added_kinetic(const State& state) const { return matrix_.added_kinetic(state.v); }

private:
    using Matrix = integrator_detail::GraphMatrix<System>;

    Report renew(Scalar h) {
        const bool serves = prepared_ && shares_.revision == system_->revision() &&
                            static_cast<double>(h) <= shares_.step;
        return serves ? Report{} : prepare(h);
    }
    /// a ← M̃⁻¹M a and what pins and dissipation add, of the touched particles.
    template <class Accelerations, class Velocities>
    void correct(const Accelerations& a, const Velocities& v) {
        if (matrix_.size() == 0) return;
        for (Index j = 0; j < matrix_.size(); ++j) {
            const Index i = matrix_.particle(j);
            rows_.row(j) = (system_->mass(i) * a(i)).transpose();
        }
        matrix_.subtract_braking(v, rows_);
        if (pins_jump_) {
            matrix_.subtract_pins(
                step_,
                [&](Index i) { return typename System::Vector((v(i) - last_.v.col(i)) / step_); },
                rows_);
            pins_jump_ = false;
        }
        rows_ = solver_.solve(rows_);
        for (Index j = 0; j < matrix_.size(); ++j) a.set(matrix_.particle(j), rows_.row(j));
    }

    const System* system_;
    Options options_;
    GraphShares shares_;
    Matrix matrix_;
    Solver solver_;
    typename Matrix::Rows rows_;
    integrator_detail::ExplicitSteps<System> steps_;
    std::int64_t factorizations_ = 0;
    bool prepared_ = false;
    // Of springs with a share that end at pins.
    State last_;              // as the last step left it
    Scalar step_ = 0;         // s
    bool pins_jump_ = false;  // before the next step
};

template <class System, class Solver>
Report GraphInertia<System, Solver>::prepare(Scalar h) {
    if (!(h > 0) || !std::isfinite(h)) return {Status::invalid_step};
    prepared_ = false;
    shares_ = graph_shares(*system_, static_cast<double>(h), options_.margin);
    if (shares_.status != Status::ok) return {shares_.status};
    if (options_.dissipation == 1) shares_.make_all_implicit();
    const Report built =
        matrix_.build(*system_, shares_, options_.dissipation, options_.most_factor_entries);
    if (!built) return built;
    rows_.resize(matrix_.size(), System::Dim);
    if (matrix_.size() > 0) {
        solver_.analyzePattern(matrix_.matrix());
        solver_.factorize(matrix_.matrix());
        ++factorizations_;
        if (solver_.info() != Eigen::Success) return {Status::not_positive_definite};
    }
    prepared_ = true;
    return {};
}

template <class System, class Solver>
template <class AnyState>
Report GraphInertia<System, Solver>::step(AnyState& state, Scalar h, Index count) {
    const Report checked = integrator_detail::StepLoop<State>::check(*system_, state, h);
    if (!checked || count <= 0) return checked;
    if (const Report renewed = renew(h); !renewed) return renewed;
    const bool goes_on = matrix_.holds_pins() && static_cast<Scalar>(state.time) == last_.time &&
                         last_.x.cols() == state.x.cols() &&
                         last_.x == state.x.template cast<Scalar>();
    step_ = h;
    const auto correction = [this](const auto& a, const auto& v) { correct(a, v); };
    bool first = true;
    const Report report = steps_.run(
        *system_, state, h, count,
        [&](auto& sweep, int threads, const StepDamping&) {
            pins_jump_ = goes_on;
            return sweep.run_corrected(*system_, state, h, count, threads, correction);
        },
        [&](State& own) {
            pins_jump_ = goes_on && first;
            first = false;
            steps_.corrected_step(*system_, own, h, correction);
        });
    if (!matrix_.holds_pins() || !report) {
        last_ = {};
    } else if constexpr (model_detail::is_state_view_v<AnyState>) {
        state.copy_to(last_);
    } else {
        last_ = state;
    }
    return report;
}

}  // namespace taut
