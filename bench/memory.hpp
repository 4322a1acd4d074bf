// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace bench {

/// Bytes by which a job raises the resident memory of a fresh child process, at its peak.
/// Linux with glibc.
template <class Job>
double peak_bytes(Job&& job) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0) return 0;
    std::fflush(nullptr);
    if (fork() == 0) {
        const auto resident = [] {
            long pages = 0;
            long ignored = 0;
            if (FILE* file = std::fopen("/proc/self/statm", "r")) {
                if (std::fscanf(file, "%ld %ld", &ignored, &pages) != 2) pages = 0;
                std::fclose(file);
            }
            return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE));
        };
        malloc_trim(0);
        const double before = resident();
        std::forward<Job>(job)();
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        const double peak = static_cast<double>(usage.ru_maxrss) * 1024 - before;
        if (write(pipe_ends[1], &peak, sizeof peak) != sizeof peak) _exit(1);
        _exit(0);
    }
    double peak = 0;
    if (read(pipe_ends[0], &peak, sizeof peak) != sizeof peak) peak = 0;
    wait(nullptr);
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    return peak;
}

}  // namespace bench
