// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

/// The wall's clock; a thread's own processor time, which others on the machine disturb least; and
/// that of all threads of this process.
constexpr clockid_t wall = CLOCK_MONOTONIC;
#ifdef __EMSCRIPTEN__
constexpr clockid_t thread_time = wall;  // the only one there is
#else
constexpr clockid_t thread_time = CLOCK_THREAD_CPUTIME_ID;
#endif
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

/// Jobs that take turns, so that a busy minute meets them all. The others stand beside the first.
class Turns {
public:
    /// @param items  of a job: what times are divided by
    explicit Turns(double items = 1, clockid_t clock = thread_time)
        : items_(items), clock_(clock) {}

    template <class... Jobs>
    void turn(Jobs&&... jobs) {
        std::size_t job = 0;
        times_.resize(sizeof...(jobs));
        (time(job++, jobs), ...);
    }
    /// After one turn that does not count.
    template <class... Jobs>
    void run(int turns, Jobs&&... jobs) {
        (jobs(), ...);
        for (int i = 0; i < turns; ++i) turn(jobs...);
    }
    /// ms an item
    Times times(std::size_t job) const { return summary(times_[job]); }
    /// Of the least times, and the median of the turns' ratios.
    Times ratio(std::size_t job, std::size_t to = 0) const {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < times_[job].size(); ++i) {
            ratios.push_back(times_[job][i] / times_[to][i]);
        }
        return {times(job).least / times(to).least, summary(ratios).median};
    }
    /// "least of the first | least of this job (median) | ratio of both (median)"
    std::string cells(std::size_t job = 1) const {
        char text[96];
        std::snprintf(text, sizeof text, "%.4g | %s", times(0).least, cells_beside(job).c_str());
        return text;
    }
    /// The same without the first cell, beside any.
    std::string cells_beside(std::size_t job, std::size_t to = 0) const {
        const Times own = times(job), over = ratio(job, to);
        char text[80];
        std::snprintf(text, sizeof text, "%.4g (%.4g) | %.2f (%.2f)", own.least, own.median,
                      over.least, over.median);
        return text;
    }

private:
    template <class Job>
    void time(std::size_t job, Job& run) {
        const double start = now(clock_);
        run();
        times_[job].push_back((now(clock_) - start) / items_);
    }
    double items_;
    clockid_t clock_;
    std::vector<std::vector<double>> times_;  // ms an item, of each job in each turn
};

}  // namespace bench
