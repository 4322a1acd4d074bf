// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth falls on a sphere, with friction. docs/contact.md reads along.

#include <cstdio>
#include <taut/between/between.hpp>
#include <taut/contact/contact.hpp>
#include <taut/taut.hpp>

int main() {
    taut::ClothOptions options{24, 24};
    options.pin_corners = false;
    auto cloth = taut::hanging_cloth<double>(options);
    cloth.set_rayleigh({1, 0});  // some air

    const taut::Sphere<double, 3> sphere({0.5, 0.5, -0.35}, 0.3);
    taut::ContactOptions contact;
    contact.friction = 0.5;
    contact.thickness = 0.005;  // m, so that no face cuts the sphere

    auto state = cloth.initial_state();
    taut::EnergyStableEuler stepper(cloth);
    const double h = taut::energy_limit(cloth).certified;
    const auto count = static_cast<taut::Index>(1 / h) + 1;  // of a second
    taut::ContactReport<double, 3> met;
    const auto between = [&](auto& now) {
        met = taut::resolve_contacts(cloth, sphere, now, contact);
    };
    if (!taut::step_between(stepper, state, h, count, between)) return 1;
    std::printf("%d of %d particles lie on the sphere\n", static_cast<int>(met.contacts),
                static_cast<int>(cloth.size()));
    return met.contacts > 0 ? 0 : 1;
}
