// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <taut/contact/obstacle.hpp>
#include <taut/contact/pose.hpp>
#include <taut/mesh_files/mesh_files.hpp>

/// A figure of 14 capsules that walks and runs; z is up.
namespace example {

using Vector = Eigen::Vector3f;

inline constexpr float pi = 3.14159265f;

/// A capsule in the frame of a joint, which stands on another bone; x forwards, y to the left, m.
struct Bone {
    int parent;
    Vector joint, a, b;
    float radius;
};
enum BoneIndex { pelvis, chest, neck, head, arms, forearms = 6, thighs = 8, shins = 10, feet = 12 };
inline const Bone bones[14] = {
    {pelvis, {0, 0, 0}, {0, -0.07f, 0}, {0, 0.07f, 0}, 0.12f},
    {pelvis, {0, 0, 0.12f}, {0, 0, 0.04f}, {0, 0, 0.3f}, 0.14f},
    {chest, {0, 0, 0.4f}, {0, 0, 0}, {0, 0, 0.1f}, 0.055f},
    {neck, {0, 0, 0.14f}, {0, 0, 0.05f}, {0.02f, 0, 0.13f}, 0.095f},
    {chest, {0, 0.2f, 0.33f}, {0, 0, 0}, {0, 0, -0.27f}, 0.05f},
    {chest, {0, -0.2f, 0.33f}, {0, 0, 0}, {0, 0, -0.27f}, 0.05f},
    {arms, {0, 0, -0.28f}, {0, 0, 0}, {0, 0, -0.3f}, 0.042f},
    {arms + 1, {0, 0, -0.28f}, {0, 0, 0}, {0, 0, -0.3f}, 0.042f},
    {pelvis, {0, 0.09f, -0.04f}, {0, 0, 0}, {0, 0, -0.4f}, 0.08f},
    {pelvis, {0, -0.09f, -0.04f}, {0, 0, 0}, {0, 0, -0.4f}, 0.08f},
    {thighs, {0, 0, -0.42f}, {0, 0, 0}, {0, 0, -0.4f}, 0.055f},
    {thighs + 1, {0, 0, -0.42f}, {0, 0, 0}, {0, 0, -0.4f}, 0.055f},
    {shins, {0, 0, -0.42f}, {-0.03f, 0, 0}, {0.16f, 0, 0}, 0.045f},
    {shins + 1, {0, 0, -0.42f}, {-0.03f, 0, 0}, {0.16f, 0, 0}, 0.045f},
};

/// From 0 before `from` to 1 after `to`.
template <class Scalar>
Scalar rise(Scalar t, float from, float to) {
    const Scalar s = std::clamp((t - from) / (to - from), Scalar(0), Scalar(1));
    return s * s * (3 - 2 * s);
}
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> turned(Scalar angle, int axis) {
    return Eigen::AngleAxis<Scalar>(angle, Eigen::Matrix<Scalar, 3, 1>::Unit(axis))
        .toRotationMatrix();
}
/// What hangs down goes forwards.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> swung(Scalar angle) {
    return turned(-angle, 1);
}

/// Walks, and runs round a bend, again and again.
template <class Scalar>
struct FigureOf {
    using Place = Eigen::Matrix<Scalar, 3, 1>;

    Scalar time = 0, phase = 0, heading = 0;
    Place at{0, 0, Scalar(0.94f)};
    taut::Pose<Scalar, 3> places[14];

    FigureOf() { advance(0); }
    static taut::Capsule<Scalar, 3> capsule(int i) {
        const Bone& bone = bones[i];
        return {bone.a.cast<Scalar>(), bone.b.cast<Scalar>(), bone.radius};
    }
    void advance(Scalar dt) {
        time += dt;
        const Scalar u = std::fmod(std::max(time - 1, Scalar(0)), Scalar(7));
        const Scalar going = rise(time, 1, 1.5f);
        const Scalar run = rise(u, 0.9f, 1.7f) - rise(u, 6, 6.8f);
        const Scalar speed = going * (1.4f + 3.6f * run);                  // m/s
        const Scalar bend = 1.2f * (rise(u, 2, 2.4f) - rise(u, 5, 5.4f));  // 1/s
        heading += bend * dt;
        at += speed * dt * Place(std::cos(heading), std::sin(heading), 0);
        phase += 2 * pi * speed / (0.9f + 0.45f * speed) * dt;

        const Scalar yaw = going * 0.12f * std::sin(phase), lean = going * (0.04f + 0.16f * run);
        const Scalar bob = 0.02f * run + going * (0.02f - 0.045f * run) * std::cos(2 * phase);
        Eigen::Matrix<Scalar, 3, 3> turns[14];
        turns[pelvis] = turned(heading - yaw, 2) * turned(-0.06f * speed * bend, 0);
        turns[chest] = turned(2 * yaw, 2) * swung(-lean);
        turns[neck] = turned(-yaw, 2) * swung(lean / 2);
        turns[head] = swung(lean / 2);
        for (int side = 0; side < 2; ++side) {
            const float sign = side == 0 ? 1.0f : -1.0f;
            const Scalar late = phase + 0.4f, ahead = sign * std::sin(phase);
            const Scalar lifted = (1 + sign * std::cos(late)) / 2;
            const Scalar hip = going * ((0.38f + 0.37f * run) * ahead + 0.12f * run);
            const Scalar knee = going * (0.1f + (0.75f + 0.95f * run) * lifted * lifted);
            turns[thighs + side] = swung(hip);
            turns[shins + side] = swung(-knee);
            turns[feet + side] = swung(0.6f * (knee - hip));
            turns[arms + side] =
                turned(Scalar(sign * 0.1f), 0) * swung(-(0.38f + 0.42f * run) * going * ahead);
            turns[forearms + side] = swung(0.2f + going * (0.2f + 0.9f * run));
        }
        places[pelvis] = {at + bob * Place::UnitZ(), turns[pelvis]};
        for (int i = 1; i < 14; ++i) {
            const auto& on = places[bones[i].parent];
            places[i] = {on(bones[i].joint.cast<Scalar>()), on.rotation * turns[i]};
        }
    }
};
using Figure = FigureOf<float>;

/// Its capsules have so many points to draw.
inline constexpr int figure_points = 14 * 96;

/// Points of the figure's capsules, 8 rings of 12 each.
template <class Scalar>
void draw(const FigureOf<Scalar>& figure, taut::Points<Scalar, 3>& x, taut::Index next) {
    for (int i = 0; i < 14; ++i) {
        const Vector along = (bones[i].b - bones[i].a).normalized();
        const Vector side = along.unitOrthogonal();
        for (int k = 0; k < 96; ++k) {
            const float up = pi * (float(k / 12) / 7 - 0.5f), round = pi / 6 * float(k % 12);
            const Vector out =
                std::sin(up) * along + std::cos(up) * (Eigen::AngleAxisf(round, along) * side);
            const Vector& end = k < 48 ? bones[i].a : bones[i].b;
            const Vector point = end + bones[i].radius * out;
            x.col(next++) = figure.places[i](point.cast<Scalar>());
        }
    }
}

/// Their faces, the first of these points being `first`.
inline void add_faces(taut::Index first, taut::MeshFaces& faces) {
    for (int k = 0; k < figure_points; ++k) {
        if (k % 96 >= 84) continue;
        const taut::Index a = first + k, b = k % 12 < 11 ? a + 1 : a - 11;
        faces.push_back({a, b, b + 12, a + 12});
    }
}

}  // namespace example
