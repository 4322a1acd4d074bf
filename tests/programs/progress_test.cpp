// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "../../examples/common/progress.hpp"
#include "../support/catch.hpp"

namespace taut_test::progress_test {

using example::Progress;

TEST_CASE("progress: says what a program is at, and only when it lasts", "[programs]") {
    std::vector<std::string> said;
    std::atomic<int> count{0};
    {
        Progress progress(0.01, [&](const std::string& line) {
            said.push_back(line);
            ++count;
        });
        progress.at("first");
        while (count == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        progress.at("second");
        for (const int before = count; count < before + 2;)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(said.front().rfind("first, ", 0) == 0);
    CHECK(said.back().rfind("second, ", 0) == 0);
    CHECK(said.back().find(" s after the start") != std::string::npos);

    said.clear();
    {
        Progress quick(1000, [&](const std::string& line) { said.push_back(line); });
        quick.at("nothing that lasts");
    }  // ends at once, not after its period
    {
        Progress unasked(0.001, {});
        unasked.at("nobody listens");
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CHECK(said.empty());
}

}  // namespace taut_test::progress_test
