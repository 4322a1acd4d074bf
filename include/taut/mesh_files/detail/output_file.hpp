// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "../../core/detail/finite.hpp"
#include "../file_report.hpp"

namespace taut::io_detail {

/// A file that is created anew, and remembers whether anything of it was lost.
class OutputFile {
public:
    explicit OutputFile(std::string path)
        : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {}

    /// Null when the file could not be created.
    std::FILE* get() const { return file_.get(); }
    bool is_open() const { return file_ != nullptr; }
    FileReport report(FileStatus status, Index where = -1) const { return {status, path_, where}; }
    /// Whether all that was written so far was taken.
    FileReport report() const {
        if (!is_open()) return report(FileStatus::not_opened);
        return report(std::ferror(file_.get()) == 0 ? FileStatus::ok : FileStatus::not_written);
    }
    /// The same when the last byte has left the program.
    FileReport close() {
        FileReport last = report();
        if (is_open() && std::fclose(file_.release()) != 0) last.status = FileStatus::not_written;
        return last;
    }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
};

/// The first column that is not finite as Number, or −1.
template <class Number, class Points>
Index first_unwritable(const Points& x) {
    for (Index i = 0; i < x.cols(); ++i) {
        for (Index d = 0; d < x.rows(); ++d) {
            if (!detail::is_finite(static_cast<Number>(x(d, i)))) return i;
        }
    }
    return -1;
}

}  // namespace taut::io_detail
