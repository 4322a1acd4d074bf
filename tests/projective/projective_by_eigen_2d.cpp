// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "projective_on.hpp"

namespace taut_test {

std::unique_ptr<AnyProjective> projective_by_eigen_in_2d(const Scene& scene) {
    return make_projective<ByEigen, AnyLaw<double, 2>>(scene, {});
}

}  // namespace taut_test
