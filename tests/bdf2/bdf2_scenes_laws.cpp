// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "bdf2_on.hpp"

namespace taut_test {

std::unique_ptr<AnyStepper> direct_bdf2_of_laws(const Scene& scene) {
    return make_stepper<DirectBdf2, AnyLaw<double, 3>>(scene);
}

}  // namespace taut_test
