// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

namespace bench {

struct Times {
    double least = 0;   // ms
    double median = 0;  // ms
};

template <class Job>
Times measure(int runs, Job&& job) {
    std::vector<double> times;
    job();  // warm-up
    for (int run = 0; run < runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        job();
        times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
    }
    std::sort(times.begin(), times.end());
    return {times.front(), times[times.size() / 2]};
}

}  // namespace bench
