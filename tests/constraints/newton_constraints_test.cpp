// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/newton/newton.hpp>

#include "check_forces.hpp"

namespace taut_test::newton_constraints_test {

namespace {

struct Newton : taut::NewtonEuler<Springs> {
    explicit Newton(const Springs& system)
        : taut::NewtonEuler<Springs>(system, [] {
              Options options;
              options.tolerance = 1e-12;
              return options;
          }()) {}
};

}  // namespace

TEST_CASE("newton_constraints: with their forces a step is that of free particles",
          "[constraints]") {
    check_forces<Newton>(1e-8);
}

}  // namespace taut_test::newton_constraints_test
