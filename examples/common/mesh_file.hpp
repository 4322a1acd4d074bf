// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <taut/core/types.hpp>
#include <utility>
#include <vector>

#include "number.hpp"

namespace example {

struct MeshFile {
    taut::Points<double, 3> vertices;             // 3 × V, m
    std::vector<std::vector<taut::Index>> faces;  // corners, 0-based; two are a piece of a line
};

/// The lines of an OBJ file without their comments, however they end. One that ends in a backslash
/// goes on in the next.
class ObjLines {
public:
    explicit ObjLines(std::string text) : text_(std::move(text)) {
        if (text_.compare(0, 3, "\xEF\xBB\xBF") == 0) at_ = 3;  // byte order mark
    }
    /// False at the end.
    bool next();
    std::string_view line() const { return line_; }
    /// Of the line's first part, from 1.
    long long number() const { return number_; }

private:
    std::string_view next_part();

    std::string text_;
    std::size_t at_ = 0;
    std::string line_;
    long long number_ = 0;
    long long parts_ = 0;
};

inline std::string_view ObjLines::next_part() {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    std::string_view part = std::string_view(text_).substr(at_, end - at_);
    at_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++parts_;
    // Cut before a backslash is looked for: a comment may end in a folder's name.
    for (auto mark = part.find('#'); mark != part.npos; mark = part.find('#', mark + 1)) {
        if (mark == 0 || part[mark - 1] == ' ' || part[mark - 1] == '\t') {
            return part.substr(0, mark);
        }
    }
    return part;
}

inline bool ObjLines::next() {
    if (at_ >= text_.size()) return false;
    line_ = next_part();
    number_ = parts_;
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!line_.empty() && line_.back() == '\\' && at_ < text_.size()) {
        const std::string_view more = next_part();
        const bool apart = line_.size() < 2 || blank(line_[line_.size() - 2]) || more.empty() ||
                           blank(more.front());
        // Without a blank, 3\ and 4 may be two numbers or 34: the backslash stays, and is no
        // number.
        if (apart) line_.back() = ' ';
        line_ += more;
    }
    return true;
}

/// What reads an OBJ file: vertices, faces and lines. A vertex's weight or colour, textures,
/// normals, groups, materials and free-form surfaces are passed over; what is no line of an OBJ
/// file is refused.
class ObjReader {
public:
    explicit ObjReader(const std::string& path) : path_(path), lines_(content(path)) {}

    MeshFile read();

private:
    static std::string content(const std::string& path);
    [[noreturn]] void fail(const std::string& why) const { fail(lines_.number(), why); }
    [[noreturn]] void fail(long long line, const std::string& why) const {
        throw std::runtime_error(path_ + ":" + std::to_string(line) + ": " + why);
    }
    void read_vertex(std::string_view words);
    std::vector<taut::Index> read_corners(std::string_view words);
    taut::Index read_corner(std::string_view word);
    void require_different(std::vector<taut::Index> corners) const;

    std::string path_;
    ObjLines lines_;
    std::vector<std::array<double, 3>> vertices_;
    std::vector<std::vector<taut::Index>> faces_;
    taut::Index last_ = -1;    // the largest corner
    long long last_line_ = 0;  // where it stands
};

inline std::string ObjReader::content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    std::ostringstream bytes;
    bytes << file.rdbuf();  // nothing, from a folder
    return bytes.str();
}

inline void ObjReader::read_vertex(std::string_view words) {
    std::size_t count = 0;
    std::array<double, 3> x{};
    double value = 0;
    for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
        if (!read_number(word, value)) fail(in_quotes(word) + " is no finite number");
        if (count < x.size()) x[count] = value;
        ++count;
    }
    if (count < x.size()) fail("a vertex needs three finite numbers");
    vertices_.push_back(x);
}

/// 7, 7/1, 7//1 or 7/1/1, where −1 is the last vertex so far. @returns the vertex, from 0
inline taut::Index ObjReader::read_corner(std::string_view word) {
    std::string_view rest = word;
    long long vertex = 0;
    long long other = 0;
    bool good = std::count(word.begin(), word.end(), '/') <= 2;
    for (int i = 0; i < 3 && good; ++i) {
        const std::string_view part = rest.substr(0, rest.find('/'));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        if (i == 0) good = read_number(part, vertex) && vertex != 0;
        if (i > 0) good = part.empty() || read_number(part, other);
    }
    if (!good) fail(in_quotes(word) + " is no corner");
    const auto count = static_cast<taut::Index>(vertices_.size());
    const auto index = static_cast<taut::Index>(vertex > 0 ? vertex - 1 : count + vertex);
    if (index < 0) {
        fail("a corner is " + std::string(word) + " after " + std::to_string(count) + " vertices");
    }
    if (index > last_) {
        last_ = index;
        last_line_ = lines_.number();
    }
    return index;
}

inline std::vector<taut::Index> ObjReader::read_corners(std::string_view words) {
    std::vector<taut::Index> corners;
    for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
        corners.push_back(read_corner(word));
    }
    if (corners.size() < 2) fail("a face or line needs at least two corners");
    return corners;
}

inline void ObjReader::require_different(std::vector<taut::Index> corners) const {
    std::sort(corners.begin(), corners.end());
    const auto twin = std::adjacent_find(corners.begin(), corners.end());
    if (twin != corners.end()) fail("vertex " + std::to_string(*twin + 1) + " is a corner twice");
}

inline MeshFile ObjReader::read() {
    constexpr std::string_view passed_over[] = {
        "vt",   "vn",     "vp",     "p",        "g",          "s",        "mg",
        "o",    "usemtl", "mtllib", "usemap",   "lod",        "maplib",   "bevel",
        "end",  "step",   "deg",    "c_interp", "d_interp",   "parm",     "cstype",
        "bmat", "curv",   "curv2",  "surf",     "trim",       "hole",     "scrv",
        "sp",   "con",    "ctech",  "stech",    "bsp",        "bzp",      "cdc",
        "cdp",  "res",    "vw",     "t",        "shadow_obj", "trace_obj"};
    while (lines_.next()) {
        std::string_view words = lines_.line();
        const std::string_view kind = next_word(words);
        if (kind == "v") {
            read_vertex(words);
        } else if (kind == "f") {
            faces_.push_back(read_corners(words));
            require_different(faces_.back());
        } else if (kind == "l") {
            const auto corners = read_corners(words);
            for (std::size_t i = 1; i < corners.size(); ++i) {
                faces_.push_back({corners[i - 1], corners[i]});
                require_different(faces_.back());
            }
        } else if (!kind.empty() && std::find(std::begin(passed_over), std::end(passed_over),
                                              kind) == std::end(passed_over)) {
            fail(in_quotes(kind) + " begins no line of an OBJ file");
        }
    }
    if (vertices_.empty() || faces_.empty()) {
        throw std::runtime_error(path_ + ": has " + std::to_string(vertices_.size()) +
                                 " vertices and " + std::to_string(faces_.size()) +
                                 " faces or lines; a mesh in OBJ text form is needed");
    }
    const auto count = static_cast<taut::Index>(vertices_.size());
    if (last_ >= count) {
        fail(last_line_, "a corner is vertex " + std::to_string(last_ + 1) + "; there are " +
                             std::to_string(count));
    }
    MeshFile mesh;
    mesh.vertices = Eigen::Map<const taut::Points<double, 3>>(vertices_.front().data(), 3, count);
    mesh.faces = std::move(faces_);
    return mesh;
}

/// Reads an OBJ file. Faces have any number of corners; a line becomes faces of two, one a piece.
/// Throws std::runtime_error naming the file and the line.
inline MeshFile read_obj(const std::string& path) { return ObjReader(path).read(); }

}  // namespace example
