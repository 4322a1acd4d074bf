// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <string>
#include <taut/mesh_files/obj.hpp>
#include <taut/mesh_files/ply.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"

namespace taut_test::mesh_sequence_test {

TEMPLATE_TEST_CASE("mesh_sequence: files are numbered, and a frame is tried again after a failure",
                   "[io]", taut::ObjSequence, taut::PlySequence) {
    const std::string extension = std::is_same_v<TestType, taut::ObjSequence> ? ".obj" : ".ply";
    TestType frames(temporary_prefix() + "sequence_", {{0, 1, 2}}, {{2, 0}});
    Random random(3);
    const auto x = random.points<float, 3>(3, -1, 1);
    const auto y = random.points<float, 3>(3, -1, 1);
    taut::Points<float, 3> broken = x;
    broken(1, 2) = std::numeric_limits<float>::infinity();
    const TemporaryFile first("sequence_00000" + extension);
    const TemporaryFile second("sequence_00001" + extension);
    const TemporaryFile third("sequence_00002" + extension);
    REQUIRE(frames.write(x));
    CHECK(frames.path(0) == first.path);
    const auto report = frames.write(broken);
    CHECK(report.status == taut::FileStatus::not_finite);
    CHECK(report.where == 2);
    CHECK(second.bytes().empty());
    REQUIRE(frames.write(x));
    REQUIRE(frames.write(y));
    CHECK(frames.frames() == 3);
    CHECK(frames.path(123456) == temporary_prefix() + "sequence_123456" + extension);
    CHECK(second.bytes() == first.bytes());
    CHECK_FALSE(third.bytes() == first.bytes());
    // A run that was ended goes on.
    TestType more(temporary_prefix() + "sequence_", {{0, 1, 2}}, {{2, 0}}, 2);
    CHECK(more.frames() == 2);
    REQUIRE(more.write(x));
    CHECK(third.bytes() == first.bytes());
}

}  // namespace taut_test::mesh_sequence_test
