// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace example {

/// What a name leads to, through links.
inline std::filesystem::path followed(std::filesystem::path path) {
    namespace fs = std::filesystem;
    std::error_code failed;
    for (int links = 0; links < 40 && fs::is_symlink(path, failed); ++links)
        path = path.parent_path() / fs::read_symlink(path, failed);
    return path;
}

/// A file that a program reads or writes.
struct FileOption {
    std::string option;  // what a message calls it
    std::string path;    // empty: not given
    bool written = false;
};

/// Whether two names lead to one file, there already or not. Devices and FIFOs may be shared.
inline bool same_file(const std::string& a, const std::string& b) {
    namespace fs = std::filesystem;
    if (a.empty() || b.empty()) return false;
    if (a == "-" || b == "-") return a == b;  // stdout
    std::error_code failed;
    if (fs::exists(a, failed) || fs::exists(b, failed)) {
        return fs::is_regular_file(a, failed) && fs::is_regular_file(b, failed) &&
               fs::equivalent(a, b, failed);
    }
    const auto full = [&](const std::string& path) {
        return fs::weakly_canonical(fs::absolute(followed(path), failed), failed);
    };
    return full(a) == full(b);
}

/// Throws when a file that would be written is another one's too: the first would be lost.
inline void require_different(std::initializer_list<FileOption> files) {
    for (const auto* second = files.begin(); second != files.end(); ++second) {
        const auto* first = std::find_if(files.begin(), second, [&](const FileOption& file) {
            return (file.written || second->written) && same_file(file.path, second->path);
        });
        if (first == second) continue;
        throw std::runtime_error(second->option + ": " + second->path + " is the file of " +
                                 first->option + " too");
    }
}

/// Writes `text` to `path` (-: stdout). A file is written beside the old one first, so that a
/// failure leaves that one as it was, and takes over who may read it; a device or a FIFO must stay
/// what it is.
/// @param option  what the message of a failure names
inline void write_text(const std::string& text, const std::string& option,
                       const std::string& path) {
    if (path == "-") {
        std::printf("%s\n", text.c_str());
        return;
    }
    namespace fs = std::filesystem;
    std::error_code failed;
    const auto finish = [&](std::ofstream file) {
        file << text << '\n';
        file.close();
        return static_cast<bool>(file);
    };
    bool written = false;
    if (fs::exists(path, failed) && !fs::is_regular_file(path, failed)) {
        written = finish(std::ofstream(path));
    } else {
        const fs::path target = followed(path);
        const bool replaces = fs::exists(target, failed);
        fs::path draft = target;
        draft += ".part";
        while (fs::exists(fs::symlink_status(draft, failed))) draft += "_";
        // A file that may not be written is not to be replaced either.
        if (!fs::is_symlink(target, failed) &&
            (!replaces || std::ofstream(target, std::ios::app).is_open())) {
            std::ofstream file(draft);
            failed.clear();
            if (replaces) fs::permissions(draft, fs::status(target, failed).permissions(), failed);
            written = !failed && finish(std::move(file));
        }
        if (written) fs::rename(draft, target, failed);
        written = written && !failed;
        if (!written) fs::remove(draft, failed);
    }
    if (!written) throw std::runtime_error(option + ": " + path + " cannot be written");
}

}  // namespace example
