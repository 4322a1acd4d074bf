// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "chain_modes.hpp"

#include <taut/lattice/chain.hpp>

#include "../support/compiled_once.hpp"

namespace taut_test {

template <class Scalar>
ChainModes<Scalar> chain_modes() {
    taut::ChainOptions options;
    options.masses = 6;
    options.stiffness = 250;
    options.mass = 0.1;
    auto chain = taut::chain<Scalar, 1>(options);
    chain.set_rayleigh({Scalar(0.3), Scalar(1e-3)});
    const auto rest = chain.initial_state();
    const auto loaded = taut::linearize(chain, rest);
    return {taut::LinearSystem<Scalar>(loaded.mass(), loaded.damping(), loaded.stiffness()),
            taut::lowest_modes(chain, rest, 6)};
}

template ChainModes<float> chain_modes();
template ChainModes<double> chain_modes();

}  // namespace taut_test
