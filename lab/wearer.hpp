// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <taut/contact/contact.hpp>
#include <vector>

#include "scene.hpp"

namespace lab {

/// The figure that walks, and how the scene's cloth hangs on it.
class Wearer {
public:
    using State = Cloth::State;

    /// The scene is as it was laid out, on a figure that stands.
    Wearer() : contacts_(scene().cloth) {
        const auto x = scene().cloth.initial_state().x;
        pins_ = example::bone_pins(scene().cloth, garments, x, figure_);
        options_.friction = 0.3;
        options_.thickness = 0.005;  // m, so that no face of 2.5 cm cuts a capsule
        for (int k = 0; k < bodies; ++k)
            contacts_.add(Figure::capsule(k), options_, figure_.places[k]);
    }
    const Figure& figure() const { return figure_; }
    taut::Contacts<Cloth>& contacts() { return contacts_; }

    /// Moves the figure on; the pins get the velocities by which they follow. @param span  s
    void walk(State& state, double span) {
        std::copy_n(figure_.places, bodies, before_.begin());
        figure_.advance(span);
        for (int k = 0; k < bodies; ++k) contacts_.move_to(k, figure_.places[k]);
        example::send(pins_, figure_, span, state);
    }
    /// After a step of h, s, in which Contacts took no part: what is too near is moved out, and
    /// comes no nearer.
    void push_out(State& state, double h) const {
        for (int k = 0; k < bodies; ++k) {
            const example::Bone& bone = example::bones[k];
            const auto& place = figure_.places[k];
            const auto capsule = Figure::capsule(k);
            const Eigen::Vector3d middle = place((bone.a + bone.b).cast<double>() / 2);
            const double reach = (bone.a - bone.b).norm() / 2 + bone.radius + options_.thickness;
            for (taut::Index i = 0; i < scene().cloth.size(); ++i) {
                const Eigen::Vector3d x = state.x.col(i);
                if (!((x - middle).squaredNorm() < reach * reach)) continue;
                const Eigen::Vector3d y = place.inside(x);
                const auto surface = capsule.surface(y);
                const double deep = options_.thickness - surface.distance;
                if (deep <= 0 || scene().cloth.is_pinned(i)) continue;
                const Eigen::Vector3d normal = place.rotation * surface.normal;
                const Eigen::Vector3d carried = (x - before_[std::size_t(k)](y)) / h;
                state.x.col(i) += deep * normal;
                const double nearer = normal.dot(state.v.col(i) - carried);
                state.v.col(i) -= std::min(nearer, 0.0) * normal;
            }
        }
    }

private:
    static constexpr int bodies = 14;

    Figure figure_;
    std::array<taut::Pose<double, 3>, bodies> before_;  // the last step
    taut::BodyOptions options_;
    taut::Contacts<Cloth> contacts_;
    std::vector<example::BonePin<double>> pins_;
};

}  // namespace lab
