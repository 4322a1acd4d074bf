// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth falls on a sphere, with friction. docs/contact.md reads along.

#include <cstdio>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>

int main() {
    taut::ClothOptions options{24, 24};
    options.pin_corners = false;
    auto cloth = taut::hanging_cloth<double>(options);
    cloth.set_rayleigh({1, 0});  // some air

    const taut::Sphere<double, 3> sphere({0.5, 0.5, -0.35}, 0.3);
    taut::BodyOptions body;
    body.friction = 0.5;
    body.thickness = 0.005;  // m, so that no face cuts the sphere
    taut::Contacts contacts(cloth);
    const taut::Index ball = contacts.add(sphere, body);

    auto state = cloth.initial_state();
    taut::Guarded guard(cloth);
    taut::Pose<double, 3> pose;
    for (int frame = 0; frame < 90; ++frame) {
        if (frame >= 60) pose.position.z() += 0.01;  // m: up by 0.6 m/s
        contacts.move_to(ball, pose);
        if (!guard.advance(state, 1.0 / 60, contacts)) return 1;
    }
    int lie = 0;
    for (taut::Index i = 0; i < cloth.size(); ++i)
        lie += sphere.surface(pose.inside(state.x.col(i))).distance < 0.006;
    std::printf("%d of %d particles lie on the ball, which carries them\n", lie,
                static_cast<int>(cloth.size()));
    return lie > 0 ? 0 : 1;
}
