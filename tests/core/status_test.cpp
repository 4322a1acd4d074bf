// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <taut/core/status.hpp>

#include "../support/catch.hpp"

namespace taut_test::status_test {

using taut::Report;
using taut::Status;

TEST_CASE("status: every status has a sentence of its own", "[core]") {
    const auto all = {Status::ok,           Status::invalid_step,          Status::invalid_state,
                      Status::diverged,     Status::not_positive_definite, Status::solver_failed,
                      Status::not_converged};
    std::set<std::string> sentences;
    for (const Status status : all) sentences.insert(taut::describe(status));
    CHECK(sentences.size() == all.size());
    CHECK(sentences.count("") == 0);
    CHECK(sentences.count(taut::describe(static_cast<Status>(99))) == 0);
}

TEST_CASE("status: a report is true exactly when its status is ok", "[core]") {
    CHECK(static_cast<bool>(Report{}));
    CHECK(Report{}.where == -1);
    CHECK_FALSE(static_cast<bool>(Report{Status::invalid_step}));
    CHECK_FALSE(static_cast<bool>(Report{Status::not_converged, 500}));
}

}  // namespace taut_test::status_test
