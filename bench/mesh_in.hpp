// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <taut/scene/mesh.hpp>

#include "../examples/common/mesh_file.hpp"

namespace bench {

/// The name of a file without its folders.
inline std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

/// The springs and triangles of a mesh that hangs by its first vertex.
template <class Scalar>
taut::MeshSprings<Scalar> mesh_in(const example::MeshFile& file) {
    const taut::Points<Scalar, 3> vertices = file.vertices.cast<Scalar>();
    auto mesh = taut::springs_from_mesh<Scalar>(vertices, file.faces);
    mesh.system.set_gravity({0, 0, Scalar(-9.81)});
    mesh.system.pin(0);
    return mesh;
}

}  // namespace bench
