// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <fstream>
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

/// tinyobj reads what is no number as 0 and a nan as it is. Throws naming file and line.
inline void check_vertices(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    std::string line;
    for (long long number = 1; std::getline(file, line); ++number) {
        const auto first = line.find_first_not_of(" \t");
        if (first == std::string::npos || line[first] != 'v') continue;
        const char* text = line.c_str() + first + 1;
        if (*text != ' ' && *text != '\t') continue;
        double coordinate = 0;
        for (int d = 0; d < 3; ++d) {
            if (read_number(text, coordinate)) continue;
            throw std::runtime_error(path + ":" + std::to_string(number) +
                                     ": a vertex needs three finite numbers");
        }
    }
}

/// Reads an OBJ file; polygons stay whole. Throws std::runtime_error naming the file.
inline MeshFile read_obj(const std::string& path) {
    check_vertices(path);
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path, config)) {
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
