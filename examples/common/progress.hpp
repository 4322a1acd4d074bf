// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace example {

/// Whether somebody reads stderr as it comes.
inline bool stderr_is_a_terminal() {
#ifdef _WIN32
    return _isatty(2) != 0;
#else
    return isatty(2) != 0;
#endif
}

/// Says what a program is at whenever it has been silent for a while, ever more rarely.
class Progress {
public:
    using Say = std::function<void(const std::string&)>;

    /// @param period  s, before the first word; doubles with each, up to tenfold   @param say takes
    /// a line; empty: nothing is said
    Progress(double period, Say say) : period_(period), say_(std::move(say)) {
        if (say_) watcher_ = std::thread([this] { watch(); });
    }
    ~Progress() {
        if (!say_) return;
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_one();
        watcher_.join();
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// What the program is at from now on.
    void at(std::string task) {
        const std::lock_guard lock(mutex_);
        task_ = std::move(task);
    }

private:
    void watch() {
        const auto start = std::chrono::steady_clock::now();
        std::unique_lock lock(mutex_);
        double period = period_;
        while (!changed_.wait_for(lock, std::chrono::duration<double>(period),
                                  [this] { return ended_; })) {
            period = std::min(2 * period, 10 * period_);
            if (task_.empty()) continue;
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            char seconds[48];
            std::snprintf(seconds, sizeof seconds, ", %.0f s after the start", elapsed.count());
            say_(task_ + seconds);
        }
    }

    double period_;
    Say say_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string task_;
    bool ended_ = false;
    std::thread watcher_;
};

/// A line of `program` on stderr.
inline Progress::Say say_on_stderr(std::string program) {
    return [program = std::move(program)](const std::string& line) {
        std::fprintf(stderr, "%s: %s\n", program.c_str(), line.c_str());
    };
}

}  // namespace example
