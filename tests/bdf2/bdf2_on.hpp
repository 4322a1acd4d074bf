// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/bdf2/bdf2.hpp>
#include <taut/solver/sparse_cholesky.hpp>

#include "../support/scene_on.hpp"
#include "bdf2_scenes.hpp"

namespace taut_test {

template <class System>
using DirectBdf2 = taut::Bdf2<System, taut::SparseCholesky<typename System::Scalar>>;

/// Of all laws: compiled apart.
std::unique_ptr<AnyStepper> direct_bdf2_of_laws(const Scene& scene);

}  // namespace taut_test
