// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/core/revision.hpp>

#include "../support/catch.hpp"

namespace taut_test::revision_test {

TEST_CASE("revision: edits and assignments only ever raise it", "[core]") {
    taut::Revision a;
    taut::Revision b;
    for (int i = 0; i < 5; ++i) ++b;
    for (int i = 0; i < 3; ++i) ++a;
    const std::uint64_t before = a;
    a = b;
    CHECK(a > before);
    CHECK(a > b);
    const std::uint64_t again = b;
    b = a;
    CHECK(b > again);
    const taut::Revision copy = a;
    CHECK(copy == a);
}

}  // namespace taut_test::revision_test
