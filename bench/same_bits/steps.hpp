// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace bench {

/// Steps of SymplecticEuler of a hanging cloth, compiled without TAUT_SAME_BITS and with it.
class Steps {
public:
    virtual ~Steps() = default;
    virtual void take(int count) = 0;
    virtual double springs() const = 0;
};

template <class Scalar>
std::unique_ptr<Steps> plain_steps(int side);
template <class Scalar>
std::unique_ptr<Steps> same_bits_steps(int side);

}  // namespace bench
