// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <taut/guard/guard.hpp>
#include <taut/recommend/candidate.hpp>
#include <variant>

namespace lab {

/// A system in motion by any method of the page.
template <class System>
class Stepping {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int guarded = static_cast<int>(taut::Method::last) + 1;

    State state;

    /// At rest.
    explicit Stepping(const System& system) : state(system.initial_state()), system_(&system) {}

    taut::Status step(int method, Scalar h, taut::Index count) {
        if (method != guarded) {
            take(static_cast<taut::Method>(method));
            const auto go = [&](auto& stepper) { return stepper.step(state, h, count).status; };
            return std::visit(go, *stepper_);
        }
        for (taut::Index i = 0; i < count; ++i) {
            const auto report = guard().advance(state, span(h));
            if (!report) return report.status;
        }
        return taut::Status::ok;
    }
    auto& guard() {
        if (!guard_) guard_.emplace(*system_);
        return *guard_;
    }
    /// As much of a frame of h, s, as the guard takes in hundreds of steps: of a light and stiff
    /// cloth a whole one would take the page minutes.
    Scalar span(Scalar h) {
        const auto& limit = guard().limit();
        return std::min(
            h, 300 * (limit ? limit->certified : taut::any_pose_limit(*system_).certified));
    }
    taut::EnergyStableEuler<System>& energy_stable() {
        constexpr auto method = taut::Method::energy_stable_euler;
        take(method);
        return std::get<static_cast<std::size_t>(method)>(*stepper_);
    }

private:
    using Gradients = taut::ConjugateGradient<Scalar, 3>;

    void take(taut::Method method) {
        if (stepper_ && stepper_->index() == static_cast<std::size_t>(method)) return;
        taut::method::visit(method, [&](auto descriptor) {
            using Descriptor = decltype(descriptor);
            constexpr auto index = static_cast<std::size_t>(Descriptor::method);
            auto& taken = stepper_.emplace(std::in_place_index<index>, *system_);
            if constexpr (Descriptor::is_implicit) {
                // As exact as what is timed for the recommendation.
                const auto tolerance = static_cast<Scalar>(taut::Candidate{}.solver_tolerance);
                std::get<index>(taken).configure(
                    [&](Gradients& solver) { solver.setTolerance(tolerance); });
            }
        });
    }

    const System* system_;
    std::optional<taut::Steppers<std::variant, System, Gradients>> stepper_;
    std::optional<taut::Guarded<taut::VelocityVerlet<System>>> guard_;
};

}  // namespace lab
