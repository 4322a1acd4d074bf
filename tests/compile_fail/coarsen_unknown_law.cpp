// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::coarsen: specialise taut::CoarseLaw for a law with parameters of its own

#include <taut/resolution/coarsen.hpp>

#include "../support/laws.hpp"

void coarsen(const taut::SpringSystem<double, 3, taut_test::Glue>& system) {
    taut::coarsen(system, 10);
}
