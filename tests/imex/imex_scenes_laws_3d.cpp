// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "imex_on.hpp"

namespace taut_test {

std::unique_ptr<AnyImex> imex_of_laws_in_3d(const Scene& scene, const taut::ImexOptions& options) {
    return make_imex<AnyLaw<double, 3>, AnyLaw<float, 3>>(scene, options);
}

}  // namespace taut_test
