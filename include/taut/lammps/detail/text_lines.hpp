// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace taut::io_detail {

/// visit(word) for each of the words between spaces.
template <class Visitor>
void for_each_word(const char* text, Visitor&& visit) {
    for (;;) {
        text += std::strspn(text, " \t\r");
        const std::size_t length = std::strcspn(text, " \t\r");
        if (length == 0) return;
        visit(std::string(text, length));
        text += length;
    }
}

/// The lines of a text file, one at a time. A last line without its end is none: it may have been
/// cut within a number.
class TextLines {
public:
    explicit TextLines(const std::string& path)
        : file_(std::fopen(path.c_str(), "rb")), line_(256) {
        const char* const point = std::localeconv()->decimal_point;
        point_ = point != nullptr && *point != '\0' ? *point : '.';
    }

    bool is_open() const { return file_ != nullptr; }
    /// Goes to the next line. False at the end.
    bool next();
    /// Whether the file ended within a line, or could not be read further.
    bool broken() const { return broken_; }
    /// Whether it went on with what is no line of text.
    bool binary() const { return binary_; }
    /// Of the line, from 1.
    long long number() const { return number_; }

    /// Whether the line is these words.
    bool is(const char* words) const { return std::strcmp(line_.data(), words) == 0; }
    /// What follows these words, or null if the line does not begin with them.
    const char* starts(const char* words) const {
        const std::size_t length = std::strlen(words);
        return std::strncmp(line_.data(), words, length) == 0 ? line_.data() + length : nullptr;
    }
    /// The first 40 bytes, what is not ASCII text as '?'.
    std::string excerpt() const {
        std::string text = std::string(line_.data()).substr(0, 40);
        for (char& c : text) {
            if (c < ' ' || c > '~') c = '?';
        }
        return text;
    }

    /// To the line's first word.
    void rewind() { at_ = line_.data(); }
    /// The next word as a number, nan and inf included. False if it is none.
    bool read(double& number);
    bool read(long long& number);
    /// Passes over a word. False at the end.
    bool skip() {
        at_ += std::strspn(at_, " \t");
        const std::size_t length = std::strcspn(at_, " \t");
        at_ += length;
        return length > 0;
    }
    bool at_end() const { return at_[std::strspn(at_, " \t")] == '\0'; }
    /// The line's one number.
    template <class Number>
    bool only(Number& number) {
        rewind();
        return read(number) && at_end();
    }

private:
    bool ended(const char* end) {
        const bool whole = end != at_ && (*end == '\0' || *end == ' ' || *end == '\t');
        at_ = end;
        return whole;
    }

    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<char> line_;  // ends with '\0'
    const char* at_ = nullptr;
    long long number_ = 0;
    bool broken_ = false;
    bool binary_ = false;
    char point_;  // of the program's locale, which strtod reads
};

inline bool TextLines::next() {
    std::size_t used = 0;
    for (;;) {
        const auto room = static_cast<int>(line_.size() - used);
        if (std::fgets(line_.data() + used, room, file_.get()) == nullptr) {
            broken_ = used > 0 || std::ferror(file_.get()) != 0;
            line_[0] = '\0';
            return false;
        }
        if (used == 0) ++number_;
        used += std::strlen(line_.data() + used);
        if (used > 0 && line_[used - 1] == '\n') break;
        constexpr std::size_t longest = 1 << 16;  // no dump of ours has lines of a tenth of it
        const bool filled = used + 1 == line_.size();
        if (!filled || line_.size() >= longest) {
            broken_ = true;
            binary_ = std::feof(file_.get()) == 0;  // a zero byte, or no end of the line in sight
            line_[0] = '\0';
            return false;
        }
        line_.resize(2 * line_.size());
    }
    --used;
    while (used > 0 && line_[used - 1] == '\r') --used;
    while (used > 0 && (line_[used - 1] == ' ' || line_[used - 1] == '\t')) --used;
    line_[used] = '\0';
    return true;
}

inline bool TextLines::read(double& number) {
    at_ += std::strspn(at_, " \t");
    if (point_ != '.') {
        for (char* c = line_.data() + (at_ - line_.data()); *c != '\0' && *c != ' '; ++c) {
            if (*c == '.') *c = point_;
        }
    }
    char* end = nullptr;
    number = std::strtod(at_, &end);
    return ended(end);
}

inline bool TextLines::read(long long& number) {
    char* end = nullptr;
    errno = 0;
    number = std::strtoll(at_, &end, 10);
    const bool fits = errno == 0;
    return ended(end) && fits;
}

}  // namespace taut::io_detail
