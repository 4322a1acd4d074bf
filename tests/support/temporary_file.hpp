// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace taut_test {

/// Before the names of this process's files: CTest runs the cases of a program side by side, each
/// in a process of its own, in one directory.
inline const std::string& temporary_prefix() {
    static const std::string prefix = "taut_test_" + std::to_string(std::random_device{}()) + "_";
    return prefix;
}

/// A file in the working directory that is removed at the end of the test.
struct TemporaryFile {
    explicit TemporaryFile(const std::string& name) : path(temporary_prefix() + name) {}
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
