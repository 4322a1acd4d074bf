// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <string>
#include <taut/conditions/visit.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/methods.hpp"

namespace taut_test::method_test {

using taut::Method;

TEST_CASE("method: names are spelled as in the programs' JSON", "[conditions]") {
    CHECK(std::string(taut::name(Method::explicit_euler)) == "explicit_euler");
    CHECK(std::string(taut::name(Method::symplectic_euler)) == "symplectic_euler");
    CHECK(std::string(taut::name(Method::velocity_verlet)) == "velocity_verlet");
    CHECK(std::string(taut::name(Method::implicit_euler)) == "implicit_euler");
    CHECK(std::string(taut::name(Method::bdf2)) == "bdf2");
    CHECK(std::string(taut::name(Method::energy_stable_euler)) == "energy_stable_euler");
    CHECK(std::string(taut::name(static_cast<Method>(99))) == "unknown");
}

TEST_CASE("method: which are implicit is known at compile time", "[conditions]") {
    STATIC_REQUIRE(taut::is_implicit(Method::bdf2));
    STATIC_REQUIRE(taut::is_implicit(Method::implicit_euler));
    STATIC_REQUIRE(!taut::is_implicit(Method::velocity_verlet));
}

TEST_CASE("method: visit finds the descriptor of each, at run time and at compile time",
          "[conditions]") {
    for (int i = 0; i <= static_cast<int>(Method::last); ++i) {
        const auto method = static_cast<Method>(i);
        CHECK(taut::method::visit(method, [](auto d) { return decltype(d)::method; }) == method);
    }
    STATIC_REQUIRE(std::is_same_v<taut::method::Of<Method::bdf2>, taut::method::Bdf2>);
    STATIC_REQUIRE(taut::method::Of<Method::last>::method == Method::last);
    const auto message =
        message_of([] { (void)taut::method::visit(static_cast<Method>(-1), [](auto) {}); });
    CHECK(missing(message, {"there is no method -1"}) == "");
}

TEST_CASE("method: what is not proved is refused by name", "[conditions]") {
    const auto message = message_of([] {
        (void)taut::method::visit_limited("a function", Method::bdf2, [](auto) { return 1; });
    });
    CHECK(missing(message, {"a function", "bdf2", "proved"}) == "");
    const auto other = message_of([] {
        (void)taut::method::visit_limited("a function", Method::energy_stable_euler,
                                          [](auto) { return 1; });
    });
    CHECK(missing(other, {"a function", "energy_stable_euler", "energy_limit"}) == "");
    CHECK(limited_methods.size() == 4);
    for (const Method method : limited_methods)
        CHECK(taut::method::visit_limited("", method, [](auto) { return 1; }) == 1);
}

}  // namespace taut_test::method_test
