// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <taut/contact/contact.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "scene.hpp"
#include "stepping.hpp"

namespace lab {

/// The figure that walks in a cape and a skirt: those of the scene, but of threads that do not
/// push, in float.
class Wearer {
public:
    /// On a figure that stands.
    Wearer() {
        const auto x = example::lay_out(garments, figure_);
        taut::MeshFaces faces;
        example::add_garments<taut::TensionOnly>(cloth_, faces, garments, x, {1, 1, 1});
        for (taut::Index i = 0; i < cloth_.size(); ++i)
            scene().cloth.is_pinned(i) ? cloth_.pin(i) : cloth_.unpin(i);
        follow();
        pins_ = example::bone_pins(cloth_, garments, x, figure_);
        stepping_.emplace(cloth_);
        contacts_.emplace(cloth_);
        options_.friction = 0.3;
        options_.thickness = 0.006;  // m, so that no face of 3 cm cuts a capsule
        for (int k = 0; k < bodies; ++k)
            contacts_->add(example::Figure::capsule(k), options_, figure_.places[k]);
    }
    Wearer(const Wearer&) = delete;
    Wearer& operator=(const Wearer&) = delete;

    const auto& state() const { return stepping_->state; }
    const example::Figure& figure() const { return figure_; }
    float depth() const { return example::depth(figure_, cloth_, state().x); }

    taut::Status step(int method, double step, taut::Index count) {
        follow();
        const auto h = static_cast<float>(step);
        auto& state = stepping_->state;
        if (method == static_cast<int>(taut::Method::energy_stable_euler)) {
            walk(h * static_cast<float>(count));
            return taut::step_through(stepping_->energy_stable(), state, h, count, *contacts_)
                .status;
        }
        for (taut::Index i = 0; i < count; ++i) {
            if (method == Stepping<Cloth>::guarded) {
                const float span = stepping_->span(h);
                walk(span);
                const auto report = stepping_->guard().advance(state, span, *contacts_);
                if (!report) return report.status;
            } else {
                walk(h);
                const taut::Status status = stepping_->step(method, h, 1);
                if (status != taut::Status::ok) return status;
                push_out(h);
            }
        }
        return taut::Status::ok;
    }

private:
    using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;
    static constexpr int bodies = 14;

    /// The scene's knobs.
    void follow() {
        const auto& leader = scene().cloth;
        if (followed_ == leader.force_revision() + 1) return;
        followed_ = leader.force_revision() + 1;
        const auto knob = static_cast<float>(scene().knob);
        for (taut::Index s = 0; s < cloth_.springs<taut::TensionOnly>().size(); ++s)
            cloth_.set_parameters<taut::TensionOnly>(s, {knob});
        for (taut::Index s = 0; s < cloth_.springs<taut::Hookean>().size(); ++s)
            cloth_.set_stiffness(s, knob * static_cast<float>(garment_bend));
        for (taut::Index i = 0; i < cloth_.size(); ++i)
            cloth_.set_mass(i, static_cast<float>(leader.mass(i)));
        cloth_.set_rayleigh(leader.rayleigh());
        cloth_.set_gravity(leader.gravity().cast<float>());
    }
    /// Moves the figure on; the pins get the velocities by which they follow. @param span  s
    void walk(float span) {
        std::copy_n(figure_.places, bodies, before_.begin());
        figure_.advance(span);
        for (int k = 0; k < bodies; ++k) contacts_->move_to(k, figure_.places[k]);
        example::send(pins_, figure_, span, stepping_->state);
    }
    /// After a step of h, s, in which Contacts took no part: what is too near is moved out, and
    /// comes no nearer.
    void push_out(float h) {
        auto& state = stepping_->state;
        for (int k = 0; k < bodies; ++k) {
            const example::Bone& bone = example::bones[k];
            const auto& place = figure_.places[k];
            const auto capsule = example::Figure::capsule(k);
            const auto thickness = static_cast<float>(options_.thickness);
            const Eigen::Vector3f middle = place((bone.a + bone.b) / 2);
            const float reach = (bone.a - bone.b).norm() / 2 + bone.radius + thickness;
            for (taut::Index i = 0; i < cloth_.size(); ++i) {
                const Eigen::Vector3f x = state.x.col(i);
                if (!((x - middle).squaredNorm() < reach * reach) || cloth_.is_pinned(i)) continue;
                const Eigen::Vector3f y = place.inside(x);
                const auto surface = capsule.surface(y);
                const float deep = thickness - surface.distance;
                if (deep <= 0) continue;
                const Eigen::Vector3f normal = place.rotation * surface.normal;
                const Eigen::Vector3f carried = (x - before_[std::size_t(k)](y)) / h;
                const float nearer = normal.dot(state.v.col(i) - carried);
                state.x.col(i) += deep * normal;
                state.v.col(i) -= std::min(nearer, 0.0f) * normal;
            }
        }
    }

    example::Figure figure_;
    std::array<taut::Pose<float, 3>, bodies> before_;  // the last step
    Cloth cloth_;
    std::uint64_t followed_ = 0;  // the revision of the scene's cloth, and one
    taut::BodyOptions options_;
    std::vector<example::BonePin> pins_;
    std::optional<Stepping<Cloth>> stepping_;
    std::optional<taut::Contacts<Cloth>> contacts_;
};

}  // namespace lab
