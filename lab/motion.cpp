// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <optional>
#include <taut/recommend/candidate.hpp>
#include <variant>

#include "lab.hpp"
#include "scene.hpp"

namespace {

using lab::Cloth;
using Gradients = taut::ConjugateGradient<double, 3>;
using Stepper = taut::Steppers<std::variant, Cloth, Gradients>;

struct Motion {
    Cloth::State state;
    std::optional<Stepper> stepper;
    taut::Points<float, 3> drawn;
    Eigen::VectorXf ringing;
};

Motion motion;

void take_stepper(taut::Method method) {
    auto& stepper = motion.stepper;
    if (stepper && stepper->index() == static_cast<std::size_t>(method)) return;
    taut::method::visit(method, [&](auto descriptor) {
        using Descriptor = decltype(descriptor);
        constexpr auto index = static_cast<std::size_t>(Descriptor::method);
        auto& taken = stepper.emplace(std::in_place_index<index>, lab::scene().cloth);
        if constexpr (Descriptor::is_implicit) {
            // As exact as what is timed for the recommendation.
            std::get<index>(taken).configure(
                [](Gradients& solver) { solver.setTolerance(taut::Candidate{}.solver_tolerance); });
        }
    });
}

taut::Report step(double h, taut::Index count) {
    return std::visit([&](auto& stepper) { return stepper.step(motion.state, h, count); },
                      *motion.stepper);
}

}  // namespace

void lab_reset() {
    motion.stepper.reset();
    motion.state = lab::scene().cloth.initial_state();
    motion.ringing = Eigen::VectorXf::Zero(lab::scene().cloth.size());
}

int lab_step(int method, double h, int count) {
    take_stepper(static_cast<taut::Method>(method));
    if (count > 1) {
        const taut::Report report = step(h, count - 1);
        if (!report) return static_cast<int>(report.status);
    }
    const taut::Points<double, 3> before = motion.state.v;
    const taut::Report report = step(h, 1);
    if (report) {
        motion.ringing =
            (h / 4 * (motion.state.v - before).colwise().norm()).transpose().cast<float>();
    }
    return static_cast<int>(report.status);
}

double lab_time() { return motion.state.time; }
const double* lab_positions() { return motion.state.x.data(); }
const float* lab_drawn_positions() {
    motion.drawn = motion.state.x.cast<float>();
    return motion.drawn.data();
}
const float* lab_ringing() { return motion.ringing.data(); }
