// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../proof/wild_system.hpp"
#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"

namespace taut_test::mass_scaling_test {

using taut::added_mass;
using taut::AddedMass;
using taut::Method;
using taut::Stability;

template <class System>
System with_added(const System& system, const AddedMass& added) {
    using Scalar = typename System::Scalar;
    System heavier = system;
    for (Index i = 0; i < system.size(); ++i) {
        const double mass =
            static_cast<double>(system.mass(i)) + added.mass[static_cast<std::size_t>(i)];
        heavier.set_mass(i, static_cast<Scalar>(mass));
    }
    return heavier;
}

/// What is said of every answer.
template <class System>
void check_account(const System& system, const AddedMass& added) {
    REQUIRE(static_cast<Index>(added.mass.size()) == system.size());
    double sum = 0;
    for (Index i = 0; i < system.size(); ++i) {
        const double mass = added.mass[static_cast<std::size_t>(i)];
        CHECK(mass >= 0);
        CHECK(std::isfinite(mass));
        if (system.is_pinned(i)) CHECK(mass == 0);
        sum += mass;
    }
    CHECK_THAT(added.total, WithinRel(sum, 1e-12) || WithinAbs(sum, 1e-300));
}

}  // namespace taut_test::mass_scaling_test
