// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "projective_on.hpp"

namespace taut_test {

const std::vector<Kind> projective_kinds = {
    {false, 1}, {true, 2}, {false, 3}, {false, 3, Laws::strings}, {false, 3, Laws::any}};

std::unique_ptr<AnyProjective> projective(const Scene& scene, const ProjectiveLimits& limits) {
    return make_projective<Default, Plain<double, 1>, Plain<float, 2>, Plain<double, 3>,
                           Strings<double, 3>, AnyLaw<double, 3>>(scene, limits);
}

}  // namespace taut_test
