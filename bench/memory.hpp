// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace bench {

/// Bytes by which a job raises the resident memory of this process above what it has been so far.
/// Linux.
template <class Job>
double peak_bytes(Job&& job) {
    const auto peak = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<double>(usage.ru_maxrss) * 1024;
    };
    const double before = peak();
    job();
    return peak() - before;
}

/// Bytes that programs may take before this machine swaps; 0: it does not say. Linux.
inline double available_bytes() {
    double kilobytes = 0;
    if (FILE* file = std::fopen("/proc/meminfo", "r")) {
        char line[128];
        while (std::fgets(line, sizeof line, file) != nullptr) {
            if (std::sscanf(line, "MemAvailable: %lf", &kilobytes) == 1) break;
        }
        std::fclose(file);
    }
    return 1024 * kilobytes;
}

/// The number that `program argument` prints: peaks are measured in a process of their own.
inline double number_from(const std::string& program, const std::string& argument) {
    double number = 0;
    if (FILE* output = popen(("'" + program + "' " + argument).c_str(), "r")) {
        if (std::fscanf(output, "%lf", &number) != 1) number = 0;
        pclose(output);
    }
    return number;
}

}  // namespace bench
