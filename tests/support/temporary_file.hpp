// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

namespace taut_test {

/// A file in the working directory that is removed at the end of the test. CTest runs tests side by
/// side: each names its own.
struct TemporaryFile {
    explicit TemporaryFile(std::string name) : path("taut_test_" + std::move(name)) {}
    ~TemporaryFile() { std::remove(path.c_str()); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    std::string bytes() const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::string path;
};

}  // namespace taut_test
