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
using Turn = Eigen::Matrix3f;

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
inline float rise(float t, float from, float to) {
    const float s = std::clamp((t - from) / (to - from), 0.0f, 1.0f);
    return s * s * (3 - 2 * s);
}
inline Turn turned(float angle, int axis) {
    return Eigen::AngleAxisf(angle, Vector::Unit(axis)).toRotationMatrix();
}
/// What hangs down goes forwards.
inline Turn swung(float angle) { return turned(-angle, 1); }

/// Walks, and runs round a bend, again and again.
struct Figure {
    float time = 0, phase = 0, heading = 0;
    Vector at{0, 0, 0.94f};
    taut::Pose<float, 3> places[14];

    Figure() { advance(0); }
    static taut::Capsule<float, 3> capsule(int i) {
        return {bones[i].a, bones[i].b, bones[i].radius};
    }
    void advance(float dt) {
        time += dt;
        const float u = std::fmod(std::max(time - 1, 0.0f), 7.0f), going = rise(time, 1, 1.5f);
        const float run = rise(u, 0.9f, 1.7f) - rise(u, 6, 6.8f);
        const float speed = going * (1.4f + 3.6f * run);                  // m/s
        const float bend = 1.2f * (rise(u, 2, 2.4f) - rise(u, 5, 5.4f));  // 1/s
        heading += bend * dt;
        at += speed * dt * Vector(std::cos(heading), std::sin(heading), 0);
        phase += 2 * pi * speed / (0.9f + 0.45f * speed) * dt;

        const float yaw = going * 0.12f * std::sin(phase), lean = going * (0.04f + 0.16f * run);
        const float bob = 0.02f * run + going * (0.02f - 0.045f * run) * std::cos(2 * phase);
        Turn turns[14];
        turns[pelvis] = turned(heading - yaw, 2) * turned(-0.06f * speed * bend, 0);
        turns[chest] = turned(2 * yaw, 2) * swung(-lean);
        turns[neck] = turned(-yaw, 2) * swung(lean / 2);
        turns[head] = swung(lean / 2);
        for (int side = 0; side < 2; ++side) {
            const float sign = side == 0 ? 1.0f : -1.0f, late = phase + 0.4f;
            const float ahead = sign * std::sin(phase), lifted = (1 + sign * std::cos(late)) / 2;
            const float hip = going * ((0.38f + 0.37f * run) * ahead + 0.12f * run);
            const float knee = going * (0.1f + (0.75f + 0.95f * run) * lifted * lifted);
            turns[thighs + side] = swung(hip);
            turns[shins + side] = swung(-knee);
            turns[feet + side] = swung(0.6f * (knee - hip));
            turns[arms + side] =
                turned(sign * 0.1f, 0) * swung(-(0.38f + 0.42f * run) * going * ahead);
            turns[forearms + side] = swung(0.2f + going * (0.2f + 0.9f * run));
        }
        places[pelvis] = {at + bob * Vector::UnitZ(), turns[pelvis]};
        for (int i = 1; i < 14; ++i) {
            const auto& on = places[bones[i].parent];
            places[i] = {on(bones[i].joint), on.rotation * turns[i]};
        }
    }
};

/// Its capsules have so many points to draw.
inline constexpr int figure_points = 14 * 96;

/// Points of the figure's capsules, 8 rings of 12 each.
inline void draw(const Figure& figure, taut::Points<float, 3>& x, taut::Index next) {
    for (int i = 0; i < 14; ++i) {
        const Vector along = (bones[i].b - bones[i].a).normalized();
        const Vector side = along.unitOrthogonal();
        for (int k = 0; k < 96; ++k) {
            const float up = pi * (float(k / 12) / 7 - 0.5f), round = pi / 6 * float(k % 12);
            const Vector out =
                std::sin(up) * along + std::cos(up) * (Eigen::AngleAxisf(round, along) * side);
            const Vector& end = k < 48 ? bones[i].a : bones[i].b;
            x.col(next++) = figure.places[i](end + bones[i].radius * out);
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
