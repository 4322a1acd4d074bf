// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <taut/core/types.hpp>
#include <utility>
#include <vector>

#include "number.hpp"

// The text of an OBJ file: what the programs and the page in the browser read alike.

namespace example {

struct MeshFile {
    taut::Points<double, 3> vertices;             // 3 × V, m
    std::vector<std::vector<taut::Index>> faces;  // corners, 0-based; two are a piece of a line
    std::string skipped;  // how many statements the reader does not know; empty: none
};

/// What a text is: a mesh, or no mesh and why.
struct ObjText {
    MeshFile mesh;
    std::vector<long long> vertex_lines;  // V, from 1
    std::string why;                      // empty: it is a mesh
    long long line = 0;                   // of what is wrong, from 1; 0: of the whole text
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

/// Whether a statement is one of the format's that says nothing of where a mesh is or what it
/// joins: textures, normals, points, groups, materials and how it is drawn.
inline bool is_beside_mesh(std::string_view kind) {
    constexpr std::string_view known[] = {
        "vt",     "vn",    "vp",       "p",        "g",          "s",
        "mg",     "o",     "usemtl",   "mtllib",   "usemap",     "lod",
        "maplib", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
    return std::find(std::begin(known), std::end(known), kind) != std::end(known);
}

/// What reads an OBJ file: vertices, faces and lines. A vertex's weight or colour is passed over,
/// and so is_beside_mesh. Other statements, as free-form surfaces and what only one program writes,
/// are skipped and counted; what begins with no name of a statement is refused. Each part returns
/// whether it could be read.
class ObjReader {
public:
    explicit ObjReader(std::string text) : lines_(std::move(text)) {}

    ObjText read();

private:
    bool fail(std::string why) { return fail(lines_.number(), std::move(why)); }
    bool fail(long long line, std::string why) {
        line_ = line;
        why_ = std::move(why);
        return false;
    }
    bool read_lines();
    bool read_line(std::string_view words);
    bool skip(std::string_view kind);
    std::string skipped() const;
    bool read_vertex(std::string_view words);
    bool read_corners(std::string_view words, std::size_t least, std::vector<taut::Index>& corners);
    bool read_corner(std::string_view word, taut::Index& index);
    bool add_face(std::vector<taut::Index> corners);

    ObjLines lines_;
    std::vector<std::array<double, 3>> vertices_;
    std::vector<long long> vertex_lines_;
    std::vector<std::vector<taut::Index>> faces_;
    taut::Index last_ = -1;                                  // the largest corner
    long long last_line_ = 0;                                // where it stands
    std::map<std::string, long long, std::less<>> skipped_;  // how many of each
    long long first_skipped_ = 0;                            // its line
    std::string why_;
    long long line_ = 0;
};

inline bool ObjReader::read_vertex(std::string_view words) {
    std::size_t count = 0;
    std::array<double, 3> x{};
    double value = 0;
    for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
        if (!read_number(word, value)) return fail(in_quotes(word) + " is no finite number");
        if (count < x.size()) x[count] = value;
        ++count;
    }
    if (count < x.size()) return fail("a vertex needs three finite numbers");
    vertices_.push_back(x);
    vertex_lines_.push_back(lines_.number());
    return true;
}

/// 7, 7/1, 7//1 or 7/1/1, where −1 is the last vertex so far. @param index  the vertex, from 0
inline bool ObjReader::read_corner(std::string_view word, taut::Index& index) {
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
    if (!good) return fail(in_quotes(word) + " is no corner (OBJ counts from 1)");
    const auto count = static_cast<taut::Index>(vertices_.size());
    index = static_cast<taut::Index>(vertex > 0 ? vertex - 1 : count + vertex);
    if (index < 0) {
        return fail("a corner is " + std::string(word) + " after " + std::to_string(count) +
                    " vertices");
    }
    if (index > last_) {
        last_ = index;
        last_line_ = lines_.number();
    }
    return true;
}

inline bool ObjReader::read_corners(std::string_view words, std::size_t least,
                                    std::vector<taut::Index>& corners) {
    for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
        taut::Index corner = 0;
        if (!read_corner(word, corner)) return false;
        corners.push_back(corner);
    }
    return corners.size() >= least ||
           fail(least == 2 ? "a line needs two corners" : "a face needs three corners");
}

inline bool ObjReader::add_face(std::vector<taut::Index> corners) {
    faces_.push_back(corners);
    std::sort(corners.begin(), corners.end());
    const auto twin = std::adjacent_find(corners.begin(), corners.end());
    return twin == corners.end() ||
           fail("vertex " + std::to_string(*twin + 1) + " is a corner twice");
}

inline bool ObjReader::skip(std::string_view kind) {
    const auto has = [](char low, char high, char c) { return low <= c && c <= high; };
    const bool named =
        (has('a', 'z', kind[0]) || has('A', 'Z', kind[0])) &&
        std::all_of(kind.begin(), kind.end(), [&](char c) { return has('!', '~', c); });
    if (!named) return fail(in_quotes(kind) + " begins no line of an OBJ file");
    if (skipped_.empty()) first_skipped_ = lines_.number();
    ++skipped_[std::string(kind)];
    return true;
}

/// skipped 3 statements, the first in line 2 (2 "vv", 1 "curv")
inline std::string ObjReader::skipped() const {
    if (skipped_.empty()) return {};
    constexpr int most_named = 5;
    std::string names;
    long long all = 0;
    int kinds = 0;
    for (const auto& [kind, count] : skipped_) {
        all += count;
        if (kinds < most_named)
            names += (kinds > 0 ? ", " : "") + std::to_string(count) + ' ' + in_quotes(kind);
        if (kinds++ == most_named) names += ", ...";
    }
    return "skipped " + std::to_string(all) + (all == 1 ? " statement" : " statements") +
           ", the first in line " + std::to_string(first_skipped_) + " (" + names + ')';
}

inline bool ObjReader::read_line(std::string_view words) {
    const std::string_view kind = next_word(words);
    if (kind == "v") return read_vertex(words);
    std::vector<taut::Index> corners;
    if (kind == "f") return read_corners(words, 3, corners) && add_face(std::move(corners));
    if (kind == "l") {
        if (!read_corners(words, 2, corners)) return false;
        for (std::size_t i = 1; i < corners.size(); ++i) {
            if (!add_face({corners[i - 1], corners[i]})) return false;
        }
        return true;
    }
    return kind.empty() || is_beside_mesh(kind) || skip(kind);
}

inline bool ObjReader::read_lines() {
    while (lines_.next()) {
        if (!read_line(lines_.line())) return false;
    }
    if (vertices_.empty() || faces_.empty()) {
        return fail(0, "has " + std::to_string(vertices_.size()) + " vertices and " +
                           std::to_string(faces_.size()) +
                           " faces or lines; a mesh in OBJ text form is needed");
    }
    const auto count = static_cast<taut::Index>(vertices_.size());
    return last_ < count || fail(last_line_, "a corner is vertex " + std::to_string(last_ + 1) +
                                                 "; there are " + std::to_string(count));
}

inline ObjText ObjReader::read() {
    ObjText text;
    if (!read_lines()) {
        text.why = std::move(why_);
        text.line = line_;
        return text;
    }
    text.mesh.vertices = Eigen::Map<const taut::Points<double, 3>>(
        vertices_.front().data(), 3, static_cast<taut::Index>(vertices_.size()));
    text.mesh.faces = std::move(faces_);
    text.mesh.skipped = skipped();
    text.vertex_lines = std::move(vertex_lines_);
    return text;
}

/// Reads the text of an OBJ file, without exceptions. Faces have any number of corners; a line
/// becomes faces of two, one a piece.
inline ObjText parse_obj(std::string text) { return ObjReader(std::move(text)).read(); }

}  // namespace example
