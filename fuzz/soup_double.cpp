// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "properties.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    taut_fuzz::run<taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>>(
        {data, size});
    return 0;
}
