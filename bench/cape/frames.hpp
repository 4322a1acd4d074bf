// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <taut/network/hookean.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "../../examples/common/garments.hpp"

namespace bench {

using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;
using Place = taut::Pose<float, 3>;
using Places = std::vector<Place>;

constexpr float frame = 1.0f / 60;  // s
/// Those of examples/cape.cpp.
constexpr example::Garments garments{48, 64, 64, 20};

/// A capsule in a body's frame; a ball where its ends are one. m.
struct Round {
    Eigen::Vector3f a, b;
    float radius;
};
/// What a peer is told of every contact.
struct Touch {
    float thickness = 0.005f;  // m
    float friction = 0.3f;
};
/// Where a pin is at the end of a frame.
struct PinAt {
    taut::Index particle;
    Eigen::Vector3f x;  // m
};

/// The figure of examples/cape.cpp, frame by frame, and what it wears.
class Frames {
public:
    /// @param away  of the figure from the origin at its start, m
    explicit Frames(float away = 0) : figure_(at(away)) {
        const auto x = example::lay_out(garments, figure_);
        taut::MeshFaces faces;
        example::add_garments<taut::TensionOnly>(cloth_, faces, garments, x, {8.7e-5, 1000, 2});
        cloth_.set_gravity({0, 0, -9.81f});
        cloth_.set_rayleigh({1, 2e-5});
        bone_pins_ = example::bone_pins(cloth_, garments, x, figure_);
        see();
    }

    const Cloth& cloth() const { return cloth_; }
    const example::Figure& figure() const { return figure_; }
    static std::vector<Round> bodies() {
        std::vector<Round> bodies;
        for (const auto& bone : example::bones) bodies.push_back({bone.a, bone.b, bone.radius});
        return bodies;
    }
    void next() {
        figure_.advance(frame);
        see();
    }
    /// Of the figure, where the frame begins and where it ends.
    const Places& from() const { return from_; }
    const Places& to() const { return to_; }
    const std::vector<PinAt>& pins() const { return pins_; }

private:
    static example::Figure at(float away) {
        example::Figure figure;
        figure.at.x() += away;
        figure.advance(0);
        return figure;
    }
    void see() {
        from_ = to_;
        to_.assign(std::begin(figure_.places), std::end(figure_.places));
        pins_.clear();
        for (const auto& pin : bone_pins_)
            pins_.push_back({pin.particle, figure_.places[pin.bone](pin.at)});
    }

    example::Figure figure_;
    Cloth cloth_;
    std::vector<example::BonePin> bone_pins_;
    Places from_, to_;
    std::vector<PinAt> pins_;
};

/// Writes the scene for peers that are programs of their own: numbers of 4 bytes, the machine's.
/// Counts of particles, springs, bodies, pins, frames; of each particle x and 1/mass; of each
/// spring its ends, rest length, stiffness and whether it pushes; of each body a, b, radius; the
/// pins; then for each frame's end, that of the start first, of each body position and quaternion
/// (x, y, z, w), and of each pin x. @returns whether it could
inline bool write_scene(const std::string& path, int frames) {
    Frames scene;
    const Cloth& cloth = scene.cloth();
    std::vector<float> numbers;
    const auto put = [&](float number) { numbers.push_back(number); };
    const auto put_all = [&](const auto& v) {
        for (int d = 0; d < v.size(); ++d) put(v[d]);
    };
    for (const auto count : {cloth.size(), cloth.spring_count(), taut::Index(14),
                             taut::Index(scene.pins().size()), taut::Index(frames)})
        put(float(count));
    const auto state = cloth.initial_state();
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        put_all(state.x.col(i));
        put(cloth.inverse_mass()[i]);
    }
    const auto put_springs = [&](const auto& springs, float pushes) {
        for (const auto spring : springs) {
            for (const float number : {float(spring.a), float(spring.b), spring.rest_length,
                                       spring.parameters.stiffness, pushes})
                put(number);
        }
    };
    put_springs(cloth.springs<taut::TensionOnly>(), 0);
    put_springs(cloth.springs<taut::Hookean>(), 1);
    for (const Round& body : Frames::bodies()) {
        put_all(body.a);
        put_all(body.b);
        put(body.radius);
    }
    for (const PinAt& pin : scene.pins()) put(float(pin.particle));
    for (int f = 0; f <= frames; ++f) {
        for (const Place& place : scene.to()) {
            put_all(place.position);
            put_all(Eigen::Quaternionf(place.rotation).coeffs());
        }
        for (const PinAt& pin : scene.pins()) put_all(pin.x);
        scene.next();
    }
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) return false;
    const std::size_t written = std::fwrite(numbers.data(), sizeof(float), numbers.size(), file);
    return std::fclose(file) == 0 && written == numbers.size();
}

}  // namespace bench
