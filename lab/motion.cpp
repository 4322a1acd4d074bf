// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <optional>

#include "lab.hpp"
#include "scene.hpp"
#include "stepping.hpp"
#include "wearer.hpp"

namespace {

// In motion is the scene's cloth or, where a figure wears it, that.
std::optional<lab::Stepping<lab::Cloth>> cloth;
std::optional<lab::Wearer> wearer;

// What was returned last.
taut::Points<double, 3> places;
taut::Points<float, 3> drawn, skin;
std::vector<int> skin_triangles;
Eigen::VectorXf ringing;

template <class Motion, class State>
taut::Status step(Motion& motion, const State& state, int method, double h, int count) {
    if (count > 1) {
        const taut::Status status = motion.step(method, h, count - 1);
        if (status != taut::Status::ok) return status;
    }
    const auto before = state.v;
    const taut::Status status = motion.step(method, h, 1);
    if (status != taut::Status::ok) return status;
    const auto change = (state.v - before).colwise().norm().transpose().eval();
    ringing = (h / 4 * change.template cast<double>()).template cast<float>();
    for (taut::Index i = 0; i < ringing.size(); ++i) {
        if (lab::scene().cloth.is_pinned(i)) ringing[i] = 0;  // it is moved
    }
    return status;
}

/// What is drawn stays in the middle of the picture: points less where the figure is, m.
taut::Points<float, 3> centred(const taut::Points<float, 3>& x) {
    Eigen::Vector3f at = wearer->figure().at;
    at.z() = 0;
    return x.colwise() - at;
}

}  // namespace

void lab_reset() {
    cloth.emplace(lab::scene().cloth);
    wearer.reset();
    if (lab::scene().worn) wearer.emplace();
    ringing = Eigen::VectorXf::Zero(lab::scene().cloth.size());
}

int lab_step(int method, double h, int count) {
    const taut::Status status = wearer ? step(*wearer, wearer->state(), method, h, count)
                                       : step(*cloth, cloth->state, method, h, count);
    return static_cast<int>(status);
}

double lab_time() { return wearer ? double(wearer->state().time) : cloth->state.time; }
const double* lab_positions() {
    if (!wearer) return cloth->state.x.data();
    places = wearer->state().x.cast<double>();
    return places.data();
}
const float* lab_drawn_positions() {
    drawn = wearer ? centred(wearer->state().x) : cloth->state.x.cast<float>();
    return drawn.data();
}
const float* lab_ringing() { return ringing.data(); }

int lab_figure_size() { return wearer ? example::figure_points : 0; }
const float* lab_figure_points() {
    skin.resize(3, example::figure_points);
    example::draw(wearer->figure(), skin, 0);
    skin = centred(skin);
    return skin.data();
}
const int* lab_figure_triangles() {
    taut::MeshFaces faces;
    example::add_faces(0, faces);
    skin_triangles.clear();
    for (const auto& face : faces) {
        for (const std::size_t corner : {0, 1, 2, 0, 2, 3})
            skin_triangles.push_back(static_cast<int>(face[corner]));
    }
    return skin_triangles.data();
}
int lab_figure_triangle_count() { return example::figure_points / 8 * 7 * 2; }
const float* lab_figure_place() { return wearer->figure().at.data(); }
double lab_depth() { return double(wearer->depth()); }
