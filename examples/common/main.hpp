// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace example {

/// Runs a program's body: an exception, or output that was lost, becomes a message on stderr and
/// exit code 1.
template <class Body>
int guarded_main(const char* program, Body&& body) {
    int code = 1;
    try {
        code = body();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", program, error.what());
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        std::fprintf(stderr, "%s: the standard output cannot be written\n", program);
        return 1;
    }
    return code;
}

}  // namespace example
