// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/model/buckling.hpp>
#include <taut/model/tension_only.hpp>

#include "properties.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    taut_fuzz::run<taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>>(
        {data, size});
    return 0;
}
