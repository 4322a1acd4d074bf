// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/network/state_view.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test {

template <class Scalar>
using Cloth = taut::SpringSystem<Scalar, 3>;

/// An engine's memory: positions and velocities with strides, anything in between.
template <class Stored, int Dim>
struct Arrays {
    Arrays(Index count, Index x_stride_, Index v_stride_)
        : n(count), x_stride(x_stride_), v_stride(v_stride_) {
        x.assign(static_cast<std::size_t>(n * x_stride), Stored(-77));
        v.assign(static_cast<std::size_t>(n * v_stride), Stored(-78));
    }
    taut::StateView<Stored, Dim> view() { return {x.data(), x_stride, v.data(), v_stride, n}; }
    bool padding_untouched() const {
        const auto kept = [&](const std::vector<Stored>& numbers, Index stride, Stored padding) {
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (static_cast<Index>(i) % stride >= Dim && numbers[i] != padding) return false;
            }
            return true;
        };
        return kept(x, x_stride, Stored(-77)) && kept(v, v_stride, Stored(-78));
    }

    Index n, x_stride, v_stride;
    std::vector<Stored> x, v;
};

/// What a state is once its numbers have been stored.
template <class Stored, class Scalar, int Dim>
void round_to(taut::State<Scalar, Dim>& state) {
    state.x = state.x.template cast<Stored>().template cast<Scalar>().eval();
    state.v = state.v.template cast<Stored>().template cast<Scalar>().eval();
}

/// Steps on the arrays are those on a State, to the bit, whatever the layout; calls that follow one
/// another too.
template <class Stored, class Stepper, class System>
void check_view(const System& system, typename System::State state, double step) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    const auto h = static_cast<Scalar>(step);
    round_to<Stored>(state);
    for (const auto& [x_stride, v_stride] :
         {std::pair(Dim, Dim), std::pair(4, 4), std::pair(7, 3)}) {
        INFO("strides " << x_stride << " and " << v_stride);
        Arrays<Stored, Dim> arrays(system.size(), x_stride, v_stride);
        auto view = arrays.view();
        view.copy_from(state);
        auto expected = state;
        Stepper on_view(system);
        Stepper on_state(system);
        for (const Index count : {1, 3, 2}) {
            const auto report = on_view.step(view, h, count);
            REQUIRE(report);
            REQUIRE(on_state.step(expected, h, count));
            CHECK(report.iterations == count);
            round_to<Stored>(expected);
        }
        typename System::State result;
        view.copy_to(result);
        CHECK(result.x == expected.x);
        CHECK(result.v == expected.v);
        CHECK(std::abs(view.time - 6 * step) <= 1e-6 * step);
        CHECK(arrays.padding_untouched());
    }
}

}  // namespace taut_test
