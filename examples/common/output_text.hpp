// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace example {

/// Writes `text` to `path` (-: stdout). A file is written beside the old one first, so that a
/// failure leaves that one as it was; a device or a FIFO must stay what it is.
/// @param option  what the message of a failure names
inline void write_text(const std::string& text, const std::string& option,
                       const std::string& path) {
    if (path == "-") {
        std::printf("%s\n", text.c_str());
        return;
    }
    namespace fs = std::filesystem;
    std::error_code failed;
    const auto write = [&](const fs::path& to) {
        std::ofstream file(to);
        file << text << '\n';
        file.close();
        return static_cast<bool>(file);
    };
    bool written = false;
    if (fs::exists(path, failed) && !fs::is_regular_file(path, failed)) {
        written = write(path);
    } else {
        fs::path target = path;
        for (int links = 0; links < 40 && fs::is_symlink(target, failed); ++links)
            target = target.parent_path() / fs::read_symlink(target, failed);
        fs::path draft = target;
        draft += ".part";
        while (fs::exists(fs::symlink_status(draft, failed))) draft += "_";
        written = !fs::is_symlink(target, failed) && write(draft);
        if (written) fs::rename(draft, target, failed);
        written = written && !failed;
        if (!written) fs::remove(draft, failed);
    }
    if (!written) throw std::runtime_error(option + ": " + path + " cannot be written");
}

}  // namespace example
