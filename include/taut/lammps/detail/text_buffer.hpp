// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstdio>
#include <cstring>
#include <vector>

namespace taut::io_detail {

/// Text on its way to a file: integers and exact numbers, written out 64 KiB at a time. What the
/// file did not take is in its ferror.
class TextBuffer {
public:
    /// The file must outlive the buffer, and be written by it alone until flush().
    explicit TextBuffer(std::FILE* file) : file_(file), text_(size) {}
    TextBuffer(const TextBuffer&) = delete;
    TextBuffer& operator=(const TextBuffer&) = delete;

    TextBuffer& operator<<(const char* words) {
        for (std::size_t left = std::strlen(words); left > 0;) {
            make_room();
            const std::size_t part = left < room ? left : room;
            std::memcpy(text_.data() + used_, words, part);
            used_ += part;
            words += part;
            left -= part;
        }
        return *this;
    }
    TextBuffer& operator<<(char c) {
        make_room();
        text_[used_++] = c;
        return *this;
    }
    TextBuffer& operator<<(long long number) {
        make_room();
        char* const at = text_.data() + used_;
        used_ += static_cast<std::size_t>(std::to_chars(at, at + room, number).ptr - at);
        return *this;
    }
    /// Seventeen digits, which name one double, with a point whatever the program's locale is.
    TextBuffer& operator<<(double number) {
        if (number == 0) return *this << '0';  // most coordinates of flat scenes, and velocities
        make_room();
        char* const at = text_.data() + used_;
        const int length = std::snprintf(at, room, "%.17g", number);
        for (int i = 0; i < length; ++i) {
            if (at[i] == ',') at[i] = '.';
        }
        used_ += static_cast<std::size_t>(length);
        return *this;
    }
    void flush() {
        std::fwrite(text_.data(), 1, used_, file_);
        used_ = 0;
    }

private:
    static constexpr std::size_t size = 1 << 16;
    static constexpr std::size_t room = 64;  // of one number

    void make_room() {
        if (used_ + room > size) flush();
    }

    std::FILE* file_;
    std::vector<char> text_;
    std::size_t used_ = 0;
};

}  // namespace taut::io_detail
