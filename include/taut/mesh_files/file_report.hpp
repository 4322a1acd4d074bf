// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../core/types.hpp"

namespace taut {

/// What can become of a file that is written.
enum class FileStatus {
    ok,
    not_opened,   ///< the file could not be created: no such folder, or no right to
    not_written,  ///< opened, but not everything could be written: a full disk
    not_finite    ///< a position or velocity is not finite, or too large for the file's numbers
};

/// One sentence for people.
constexpr const char* describe(FileStatus status) {
    switch (status) {
        case FileStatus::ok: return "ok";
        case FileStatus::not_opened: return "cannot be written: it could not be created";
        case FileStatus::not_written: return "cannot be written completely";
        case FileStatus::not_finite:
            return "a position or velocity is not finite, or too large for the file";
    }
    return "unknown status";
}

/// Outcome of a writer; false when the file is not complete.
struct [[nodiscard]] FileReport {
    FileStatus status = FileStatus::ok;
    std::string path;  ///< the file in question
    Index where = -1;  ///< the particle of not_finite, or −1

    /// Whether status is ok.
    explicit operator bool() const { return status == FileStatus::ok; }
    /// "cloth.pc2: cannot be written completely"
    std::string message() const {
        std::string text = path + ": " + describe(status);
        if (where >= 0) text += ", particle " + std::to_string(where);
        return text;
    }
};

}  // namespace taut
