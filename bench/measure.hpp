// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace bench {

/// The wall's clock; a thread's own processor time, which others on the machine disturb least; and
/// that of all threads of this process.
constexpr clockid_t wall = CLOCK_MONOTONIC;
constexpr clockid_t thread_time = CLOCK_THREAD_CPUTIME_ID;
constexpr clockid_t process_time = CLOCK_PROCESS_CPUTIME_ID;

/// ms
inline double now(clockid_t clock = wall) {
    std::timespec time{};
    clock_gettime(clock, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Times {
    double least = 0;   // ms
    double median = 0;  // ms
};

inline Times summary(std::vector<double> times) {
    if (times.empty()) return {};
    std::sort(times.begin(), times.end());
    return {times.front(), times[times.size() / 2]};
}

class Stopwatch {
public:
    explicit Stopwatch(clockid_t clock = wall) : clock_(clock) {}

    template <class Job>
    void run(Job&& job) {
        const double start = now(clock_);
        job();
        times_.push_back(now(clock_) - start);
    }
    Times times() const { return summary(times_); }

private:
    clockid_t clock_;
    std::vector<double> times_;  // ms
};

template <class Job>
Times measure(int runs, Job&& job) {
    job();  // warm-up
    Stopwatch watch;
    for (int run = 0; run < runs; ++run) watch.run(job);
    return watch.times();
}

}  // namespace bench
