// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "lab.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <taut/taut.hpp>
#include <variant>

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using taut::Method;

using Gradients = taut::ConjugateGradient<double, 3>;
using Stepper = std::variant<taut::ExplicitEuler<Cloth>, taut::SymplecticEuler<Cloth>,
                             taut::VelocityVerlet<Cloth>, taut::ImplicitEuler<Cloth, Gradients>,
                             taut::Bdf2<Cloth, Gradients>, taut::GraphInertia<Cloth>>;

struct Lab {
    taut::ClothOptions options;
    Cloth cloth;
    Cloth::State state;
    std::optional<Stepper> stepper;
    taut::Points<float, 3> drawn;
    Eigen::VectorXf ringing;
    LabLimits limits{};
    taut::Cause cause = taut::Cause::stiffness;
    double mode_k = 0;  // 1/s², of the limiting mode
    double mode_d = 0;  // 1/s
    taut::Recommendation advice;
    LabPlan plan{};
};

Lab lab;

/// CPU time would do, but a browser has none to tell; and std::clock() wraps there.
double seconds_now() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

void build(double stiffness, double mass, double alpha, double drag) {
    lab.options.stretch = stiffness;
    lab.options.bend = stiffness / 10;
    lab.options.mass = mass;
    lab.cloth = taut::hanging_cloth<double>(lab.options);
    lab.cloth.set_rayleigh({drag, alpha});
}

void take_stepper(Method method) {
    if (lab.stepper && lab.stepper->index() == static_cast<std::size_t>(method)) return;
    taut::method::visit(method, [](auto descriptor) {
        using Descriptor = decltype(descriptor);
        constexpr auto index = static_cast<std::size_t>(Descriptor::method);
        static_assert(std::variant_alternative_t<index, Stepper>::method == Descriptor::method);
        auto& stepper = lab.stepper.emplace(std::in_place_index<index>, lab.cloth);
        if constexpr (Descriptor::is_implicit) {
            // As exact as what recommend() times.
            std::get<index>(stepper).configure(
                [](Gradients& solver) { solver.setTolerance(taut::Candidate{}.solver_tolerance); });
        }
    });
}

taut::Report step(double h, taut::Index count) {
    return std::visit([&](auto& stepper) { return stepper.step(lab.state, h, count); },
                      *lab.stepper);
}

/// The limit at any pose, linearised; explicit Euler has none, implicit steps no need of one.
double any_pose(Method method) {
    using taut::method::AnyPose;
    const AnyPose safe =
        taut::method::visit(method, [](auto descriptor) { return decltype(descriptor)::any_pose; });
    if (safe == AnyPose::limited) return taut::any_pose_limit(lab.cloth).certified;
    return safe == AnyPose::every_step ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

void lab_start(int side, double stiffness, double mass, double alpha, double drag) {
    lab.options.rows = lab.options.columns = side;
    build(stiffness, mass, alpha, drag);
    lab.stepper.reset();
    lab.state = lab.cloth.initial_state();
    lab.ringing = Eigen::VectorXf::Zero(lab.cloth.size());
}

void lab_change(double stiffness, double mass, double alpha, double drag) {
    build(stiffness, mass, alpha, drag);
}

int lab_size() { return static_cast<int>(lab.cloth.size()); }
int lab_springs() { return static_cast<int>(lab.cloth.spring_count()); }

int lab_step(int method, double h, int count) {
    take_stepper(static_cast<Method>(method));
    if (count > 1) {
        const taut::Report report = step(h, count - 1);
        if (!report) return static_cast<int>(report.status);
    }
    const taut::Points<double, 3> before = lab.state.v;
    const taut::Report report = step(h, 1);
    if (report) {
        lab.ringing = (h / 4 * (lab.state.v - before).colwise().norm()).transpose().cast<float>();
    }
    return static_cast<int>(report.status);
}

double lab_time() { return lab.state.time; }
const double* lab_positions() { return lab.state.x.data(); }
const float* lab_drawn_positions() {
    lab.drawn = lab.state.x.cast<float>();
    return lab.drawn.data();
}
const float* lab_ringing() { return lab.ringing.data(); }

const LabLimits* lab_analyse(int which, double h) {
    const auto method = static_cast<Method>(which);
    const taut::Stability<double> stability(lab.cloth, lab.cloth.initial_state());
    const taut::StepLimit<double> limit = stability.max_step(method);
    const taut::LimitingMode mode = stability.limiting_mode();
    lab.cause = limit.cause;
    lab.mode_k = mode.k;
    lab.mode_d = mode.d;
    lab.limits = {any_pose(method), limit.certified, limit.refuted, 0, 0};
    const double drag = lab.cloth.rayleigh().mass_proportional;
    const taut::AlphaWindow window = stability.rayleigh_window(method, h, drag);
    if (window.empty == taut::EmptyWindow::none) {
        lab.limits.alpha_lower = window.includes_zero ? -1 : window.lower;
        lab.limits.alpha_upper = window.upper;
    }
    return &lab.limits;
}

const char* lab_cause() { return taut::describe(lab.cause); }

double lab_growth(int method, double h) {
    return taut::spectral_radius(static_cast<Method>(method), lab.mode_k, lab.mode_d, h);
}

const char* lab_recommend(double seconds) {
    taut::Calibration calibration;
    calibration.seconds = seconds;
    calibration.clock = &seconds_now;
    lab.advice = taut::recommend(lab.cloth, lab.state, taut::Goal{}, calibration);
    return lab.advice.why.c_str();
}

int lab_plan_count() { return static_cast<int>(lab.advice.plans.size()); }

const LabPlan* lab_plan(int i) {
    const taut::Plan& plan = lab.advice.plans[static_cast<std::size_t>(i)];
    const Method method = plan.candidate.scheme;
    const bool gradients = plan.candidate.solver == taut::LinearSolver::conjugate_gradient;
    lab.plan = {static_cast<double>(method), is_implicit(method) && gradients ? 1.0 : 0.0,
                static_cast<double>(plan.substeps), plan.candidate.h, plan.cost};
    return &lab.plan;
}
