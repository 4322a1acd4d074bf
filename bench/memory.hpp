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
