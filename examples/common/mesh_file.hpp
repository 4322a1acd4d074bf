// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <stdexcept>
#include <string>
#include <taut/core/types.hpp>
#include <vector>

namespace example {

struct MeshFile {
    taut::Points<double, 3> vertices;             // 3 × V, m
    std::vector<std::vector<taut::Index>> faces;  // corners, 0-based
};

/// Reads an OBJ file; polygons stay whole. Throws std::runtime_error naming the file.
inline MeshFile read_obj(const std::string& path) {
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path, config)) {
        const std::string why = reader.Error().empty() ? "not readable as OBJ" : reader.Error();
        throw std::runtime_error(path + ": " + why);
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
