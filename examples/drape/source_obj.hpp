// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <taut/mesh_files/mesh_files.hpp>
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

/// A material library's line, by a path that holds in another folder.
inline std::string moved_library(std::string_view words, const std::filesystem::path& mesh,
                                 const std::filesystem::path& folder) {
    const std::filesystem::path library = example::next_word(words);
    std::error_code failed;
    const auto moved =
        std::filesystem::proximate(mesh.parent_path() / library, folder, failed).generic_string();
    return "mtllib " + (failed ? library.generic_string() : moved) + '\n';
}

/// What an OBJ file says of texture coordinates, groups, materials, faces and lines, in its order.
/// @param folder    where the text is to be read   @param vertices  that the file must have
inline std::string obj_without_positions(const std::string& path, const std::string& folder,
                                         taut::Index expected) {
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
        const bool joins = kind == "f" || kind == "l" || kind == "p";
        if ((!joins && !example::is_beside_mesh(kind)) || kind == "vn") continue;
        if (kind == "mtllib") {
            rest += moved_library(words, path, folder);
            continue;
        }
        rest += kind;
        if (joins) {
            for (auto word = example::next_word(words); !word.empty();
                 word = example::next_word(words)) {
                rest += ' ' + moved_corner(word, vertices);
            }
        } else {
            rest += words;  // with the blank before it
        }
        rest += '\n';
    }
    if (vertices != expected) {
        throw std::runtime_error(path +
                                 ": is read twice, and was not the same; --format ply reads "
                                 "it once");
    }
    return rest;
}

/// A sequence of OBJ files that are the mesh's own file with other positions.
class SourceSequence {
public:
    /// @param first  the frame to begin with
    SourceSequence(const std::string& folder, const std::string& mesh, taut::Index vertices,
                   taut::Index first)
        : names_(folder + "/frame_", {}),
          rest_(obj_without_positions(mesh, folder, vertices)),
          frames_(first) {}

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
