// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <optional>
#include <taut/guard/guard.hpp>
#include <taut/recommend/candidate.hpp>
#include <variant>

#include "lab.hpp"
#include "scene.hpp"
#include "wearer.hpp"

namespace {

using lab::Cloth;
using Gradients = taut::ConjugateGradient<double, 3>;
using Stepper = taut::Steppers<std::variant, Cloth, Gradients>;

constexpr int guarded = static_cast<int>(taut::Method::last) + 1;

struct Motion {
    Cloth::State state;
    std::optional<Stepper> stepper;
    std::optional<taut::Guarded<taut::VelocityVerlet<Cloth>>> guard;
    std::optional<lab::Wearer> wearer;
    taut::Points<float, 3> drawn, skin;
    std::vector<int> skin_triangles;
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

taut::Status step(double h, taut::Index count) {
    return std::visit([&](auto& stepper) { return stepper.step(motion.state, h, count); },
                      *motion.stepper)
        .status;
}

taut::Status guard_frames(double h, taut::Index count) {
    auto& [state, stepper, guard, wearer, drawn, skin, triangles, ringing] = motion;
    if (!guard) guard.emplace(lab::scene().cloth);
    for (taut::Index i = 0; i < count; ++i) {
        if (wearer) wearer->walk(state, h);
        const auto report = wearer ? guard->advance(state, h, wearer->contacts())  //
                                   : guard->advance(state, h);
        if (!report) return report.status;
    }
    return taut::Status::ok;
}

taut::Status step_worn(taut::Method method, double h, taut::Index count) {
    constexpr auto stable = taut::Method::energy_stable_euler;
    auto& wearer = *motion.wearer;
    if (method == stable) {
        wearer.walk(motion.state, h * double(count));
        auto& stepper = std::get<static_cast<std::size_t>(stable)>(*motion.stepper);
        return taut::step_through(stepper, motion.state, h, count, wearer.contacts()).status;
    }
    for (taut::Index i = 0; i < count; ++i) {
        wearer.walk(motion.state, h);
        const taut::Status status = step(h, 1);
        if (status != taut::Status::ok) return status;
        wearer.push_out(motion.state, h);
    }
    return taut::Status::ok;
}

taut::Status advance(int method, double h, taut::Index count) {
    if (method == guarded) return guard_frames(h, count);
    take_stepper(static_cast<taut::Method>(method));
    if (!motion.wearer) return step(h, count);
    return step_worn(static_cast<taut::Method>(method), h, count);
}

/// As it is drawn: in the middle of the picture.
Eigen::Vector3d shift() {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    if (motion.wearer) at.head<2>() = motion.wearer->figure().at.head<2>();
    return at;
}

}  // namespace

void lab_reset() {
    motion.stepper.reset();
    motion.guard.reset();
    motion.wearer.reset();
    motion.state = lab::scene().cloth.initial_state();
    motion.ringing = Eigen::VectorXf::Zero(lab::scene().cloth.size());
    if (lab::scene().worn) motion.wearer.emplace();
}

int lab_step(int method, double h, int count) {
    if (count > 1) {
        const taut::Status status = advance(method, h, count - 1);
        if (status != taut::Status::ok) return static_cast<int>(status);
    }
    const taut::Points<double, 3> before = motion.state.v;
    const taut::Status status = advance(method, h, 1);
    if (status == taut::Status::ok) {
        motion.ringing =
            (h / 4 * (motion.state.v - before).colwise().norm()).transpose().cast<float>();
        for (taut::Index i = 0; i < motion.state.x.cols(); ++i) {
            if (lab::scene().cloth.is_pinned(i)) motion.ringing[i] = 0;  // it is moved
        }
    }
    return static_cast<int>(status);
}

double lab_time() { return motion.state.time; }
const double* lab_positions() { return motion.state.x.data(); }
const float* lab_drawn_positions() {
    motion.drawn = (motion.state.x.colwise() - shift()).cast<float>();
    return motion.drawn.data();
}
const float* lab_ringing() { return motion.ringing.data(); }

int lab_figure_size() { return motion.wearer ? example::figure_points : 0; }
const float* lab_figure_points() {
    taut::Points<double, 3> skin(3, lab_figure_size());
    if (motion.wearer) example::draw(motion.wearer->figure(), skin, 0);
    motion.skin = (skin.colwise() - shift()).cast<float>();
    return motion.skin.data();
}
const int* lab_figure_triangles() {
    taut::MeshFaces faces;
    example::add_faces(0, faces);
    motion.skin_triangles.clear();
    for (const auto& face : faces) {
        for (const int corner : {0, 1, 2, 0, 2, 3})
            motion.skin_triangles.push_back(static_cast<int>(face[std::size_t(corner)]));
    }
    return motion.skin_triangles.data();
}
int lab_figure_triangle_count() {
    return motion.wearer ? example::figure_points / 8 * 7 * 2 : 0;  // of 8 rings the last ends them
}
const double* lab_figure_place() { return motion.wearer->figure().at.data(); }
double lab_depth() {
    return example::depth(motion.wearer->figure(), lab::scene().cloth, motion.state.x);
}
