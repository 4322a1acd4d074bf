// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <taut/core/method.hpp>

#include "../support/catch.hpp"

namespace taut_test::method_test {

TEST_CASE("method: names are spelled as in the programs' JSON", "[core]") {
    using taut::Method;
    CHECK(std::string(taut::name(Method::explicit_euler)) == "explicit_euler");
    CHECK(std::string(taut::name(Method::symplectic_euler)) == "symplectic_euler");
    CHECK(std::string(taut::name(Method::velocity_verlet)) == "velocity_verlet");
    CHECK(std::string(taut::name(Method::implicit_euler)) == "implicit_euler");
    CHECK(std::string(taut::name(static_cast<Method>(99))) == "unknown");
}

}  // namespace taut_test::method_test
