// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <taut/taut.hpp>
#include <utility>

#include "../common/mesh_file.hpp"

namespace drape {

/// A corner of a face or line, 7/2/5 or −1/−1: its vertex counted from the first one, its texture
/// coordinate as it is, without its normal, which no longer holds.
inline std::string moved_corner(std::string_view corner, long long vertices) {
    const std::string_view vertex = corner.substr(0, corner.find('/'));
    long long index = 0;
    if (!example::read_number(vertex, index)) return std::string(corner);  // not after read_obj
    std::string text = std::to_string(index < 0 ? vertices + index + 1 : index);
    if (vertex.size() == corner.size()) return text;
    corner.remove_prefix(vertex.size() + 1);
    const std::string_view texture = corner.substr(0, corner.find('/'));
    if (!texture.empty()) text += '/' + std::string(texture);
    return text;
}

/// All that an OBJ file says but positions and normals: texture coordinates, groups, materials,
/// faces and lines, in its order.
inline std::string obj_without_positions(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    if (!file) throw std::runtime_error(path + ": cannot be read again");
    example::ObjLines lines(content.str());
    std::string rest;
    long long vertices = 0;
    while (lines.next()) {
        std::string_view words = lines.line();
        const std::string_view kind = example::next_word(words);
        if (kind == "v") ++vertices;
        if (kind.empty() || kind == "v" || kind == "vn") continue;
        rest += kind;
        if (kind == "f" || kind == "l") {
            for (auto word = example::next_word(words); !word.empty();
                 word = example::next_word(words)) {
                rest += ' ' + moved_corner(word, vertices);
            }
        } else {
            rest += words;  // with the blank before it
        }
        rest += '\n';
    }
    return rest;
}

/// A sequence of OBJ files that are the mesh's own file with other positions.
class SourceSequence {
public:
    /// @param first  the frame to begin with
    SourceSequence(std::string prefix, const std::string& mesh, taut::Index first)
        : names_(std::move(prefix), {}), rest_(obj_without_positions(mesh)), frames_(first) {}

    taut::FileReport write(const taut::Points<double, 3>& x) {
        const std::string path = names_.path(frames_);
        if (taut::FileReport report = taut::write_obj(path, x, {}); !report) return report;
        std::ofstream file(path, std::ios::binary | std::ios::app);
        file << rest_ << std::flush;
        if (!file) return {taut::FileStatus::not_written, path, -1};
        ++frames_;
        return {};
    }
    taut::Index frames() const { return frames_; }
    std::string path(taut::Index frame) const { return names_.path(frame); }

private:
    taut::ObjSequence names_;
    std::string rest_;
    taut::Index frames_;
};

}  // namespace drape
