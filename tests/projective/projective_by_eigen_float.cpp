// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "projective_on.hpp"

namespace taut_test {

std::unique_ptr<AnyProjective> projective_by_eigen_in_float(const Scene& scene) {
    return make_projective<ByEigen, Plain<float, 1>, Plain<float, 2>, AnyLaw<float, 3>>(scene, {});
}

}  // namespace taut_test
