// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
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

    /// Replaces what is in it.
    void write(const void* data, std::size_t size) const {
        std::ofstream file(path, std::ios::binary);
        file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    }
    std::string bytes() const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::string path;
};

}  // namespace taut_test
