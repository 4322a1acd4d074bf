// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "projective_on.hpp"

namespace taut_test {

std::unique_ptr<AnyProjective> projective_by_eigen(const Scene& scene) {
    if (scene.kind().single) return projective_by_eigen_in_float(scene);
    return make_projective<ByEigen, AnyLaw<double, 1>, AnyLaw<double, 2>, AnyLaw<double, 3>>(scene,
                                                                                             {});
}

}  // namespace taut_test
