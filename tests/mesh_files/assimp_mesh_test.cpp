// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// The mesh writers read back by a library that is not ours, the Open Asset Import Library.
#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <string>
#include <taut/mesh_files/obj.hpp>
#include <taut/mesh_files/ply.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::assimp_mesh_test {

namespace {

/// Quads that are cut into triangles along every other row: faces of both kinds.
taut::MeshFaces faces_of_cloth(Index rows, Index columns) {
    taut::MeshFaces faces;
    for (Index r = 0; r + 1 < rows; ++r) {
        for (Index a = r * columns; a + 1 < (r + 1) * columns; ++a) {
            const Index b = a + columns;
            if (r % 2 == 0) {
                faces.push_back({a, a + 1, b + 1, b});
            } else {
                faces.push_back({a, a + 1, b});
                faces.push_back({a + 1, b + 1, b});
            }
        }
    }
    return faces;
}

struct Read {
    double farthest = 0;  // of a corner from where it was written, m
    std::size_t faces = 0;
    bool same_corners = true;
};

/// Readers may give every face its own vertices: what is compared is where its corners are.
Read compare(const std::string& path, const taut::Points<double, 3>& x,
             const taut::MeshFaces& written) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, 0);
    INFO(importer.GetErrorString());
    REQUIRE(scene != nullptr);
    Read read;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& mesh = *scene->mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) continue;  // an edge
            if (read.faces >= written.size()) return read.same_corners = false, read;
            const auto& corners = written[read.faces++];
            read.same_corners = read.same_corners && face.mNumIndices == corners.size();
            for (std::size_t c = 0; read.same_corners && c < corners.size(); ++c) {
                const aiVector3D& p = mesh.mVertices[face.mIndices[c]];
                const Eigen::Vector3d at(p.x, p.y, p.z);
                read.farthest = std::max(read.farthest, (at - x.col(corners[c])).norm());
            }
        }
    }
    return read;
}

}  // namespace

TEMPLATE_TEST_CASE("mesh writers: Assimp reads the faces and positions that were written", "[io]",
                   taut::ObjSequence, taut::PlySequence) {
    const auto cloth = taut::hanging_cloth<double>({9, 7});
    auto state = cloth.initial_state();
    state.x += Random(1).points<double, 3>(cloth.size(), -0.05, 0.05);
    const auto faces = faces_of_cloth(9, 7);
    taut::MeshEdges edges;
    cloth.for_each_spring([&](Index a, Index b) { edges.push_back({a, b}); });
    TestType frames(temporary_prefix() + "assimp_", faces, edges);
    const TemporaryFile file(frames.path(0).substr(temporary_prefix().size()));
    REQUIRE(frames.write(state.x));
    const Read read = compare(file.path, state.x, faces);
    CHECK(read.faces == faces.size());
    CHECK(read.same_corners);
    CHECK(read.farthest <= 4 * Tolerance<float>::epsilon);  // of coordinates up to 1 m
}

}  // namespace taut_test::assimp_mesh_test
