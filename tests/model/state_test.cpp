// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/model/state.hpp>

#include "../support/catch.hpp"

namespace taut_test::state_test {

TEMPLATE_TEST_CASE("state: the first particle with a coordinate that is not finite is named",
                   "[model]", float, double) {
    using State = taut::State<TestType, 3>;
    const auto bad = GENERATE(std::numeric_limits<TestType>::quiet_NaN(),
                              std::numeric_limits<TestType>::infinity(),
                              -std::numeric_limits<TestType>::infinity());
    State state{State::zero(5), State::zero(5), TestType(0)};
    CHECK(state.finite());
    CHECK(state.first_not_finite() == -1);

    state.v(2, 4) = bad;
    CHECK_FALSE(state.finite());
    CHECK(state.first_not_finite() == 4);
    state.x(0, 3) = bad;
    CHECK(state.first_not_finite() == 3);
    state.x(1, 0) = bad;
    CHECK(state.first_not_finite() == 0);
}

TEST_CASE("state: zero has one column a particle", "[model]") {
    const auto x = taut::State<double, 2>::zero(7);
    CHECK(x.rows() == 2);
    CHECK(x.cols() == 7);
    CHECK(x.isZero(0));
}

}  // namespace taut_test::state_test
