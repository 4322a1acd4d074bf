// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/scene/mesh.hpp>

#include "../examples/common/mesh_file.hpp"

namespace bench {

/// The springs of a mesh that hangs by its first vertex.
template <class Scalar>
taut::SpringSystem<Scalar, 3> mesh_in(const example::MeshFile& file) {
    const taut::Points<Scalar, 3> vertices = file.vertices.cast<Scalar>();
    auto net = taut::springs_from_mesh<Scalar>(vertices, file.faces).system;
    net.set_gravity({0, 0, Scalar(-9.81)});
    net.pin(0);
    return net;
}

}  // namespace bench
