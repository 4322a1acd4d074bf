// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/core/types.hpp>
#include <vector>

#include "number.hpp"

namespace example {

struct MeshFile {
    taut::Points<double, 3> vertices;             // 3 × V, m
    std::vector<std::vector<taut::Index>> faces;  // corners, 0-based
};

/// The lines of an OBJ file that make its mesh, the others blank: tinyobj casts what it finds in
/// lines of bones and the like without a look, and reads what is no number as 0 and a nan as it is.
/// Throws naming file and line where a vertex is not three finite numbers or a corner is no int.
inline std::string mesh_lines(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    std::ostringstream content;
    content << file.rdbuf();  // nothing, from a folder
    const std::string text = content.str();
    const std::string byte_order_mark = "\xEF\xBB\xBF";
    std::string kept;
    long long number = 1;
    for (std::size_t begin = text.compare(0, 3, byte_order_mark) == 0 ? 3 : 0; begin < text.size();
         ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
        const auto first = std::min(line.find_first_not_of(" \t"), line.size());
        const auto last = std::min(line.find_first_of(" \t", first), line.size());
        const std::string word = line.substr(first, last - first);
        if (word == "v") {
            const char* rest = line.c_str() + last;
            double coordinate = 0;
            for (int d = 0; d < 3; ++d) {
                if (read_number(rest, coordinate)) continue;
                throw std::runtime_error(path + ":" + std::to_string(number) +
                                         ": a vertex needs three finite numbers");
            }
        }
        if (word == "f") {
            std::istringstream corners(line.substr(last));
            for (std::string corner; corners >> corner;) {
                // tinyobj's int would wrap; a name that is no number it refuses itself.
                if (std::abs(std::strtoll(corner.c_str(), nullptr, 10)) <= INT_MAX) continue;
                throw std::runtime_error(path + ":" + std::to_string(number) +
                                         ": a face has the corner " + corner);
            }
        }
        if (word == "v" || word == "vt" || word == "vn" || word == "f") kept += line;
        kept += '\n';
    }
    return kept;
}

/// Reads an OBJ file; polygons stay whole. Throws std::runtime_error naming the file.
inline MeshFile read_obj(const std::string& path) {
    const std::string lines = mesh_lines(path);
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(lines, "", config)) {
        std::string why = reader.Error();
        while (!why.empty() && (why.back() == '\n' || why.back() == '\r')) why.pop_back();
        throw std::runtime_error(path + ": " + (why.empty() ? "not readable as OBJ" : why));
    }
    MeshFile mesh;
    const auto& coordinates = reader.GetAttrib().vertices;
    mesh.vertices = Eigen::Map<const taut::Points<double, 3>>(
        coordinates.data(), 3, static_cast<taut::Index>(coordinates.size() / 3));
    for (const auto& shape : reader.GetShapes()) {
        auto corner = shape.mesh.indices.begin();
        for (const auto corners : shape.mesh.num_face_vertices) {
            auto& face = mesh.faces.emplace_back();
            for (unsigned i = 0; i < corners; ++i) face.push_back((corner++)->vertex_index);
        }
    }
    if (mesh.vertices.cols() == 0 || mesh.faces.empty()) {
        throw std::runtime_error(path + ": has " + std::to_string(mesh.vertices.cols()) +
                                 " vertices and " + std::to_string(mesh.faces.size()) +
                                 " faces; a mesh in OBJ text form is needed");
    }
    return mesh;
}

}  // namespace example
