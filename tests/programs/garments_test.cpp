// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>
#include <taut/step/force_plan.hpp>
#include <taut/scene/mesh.hpp>

#include "../../examples/common/mesh_file.hpp"
#include "../support/catch.hpp"

namespace taut_test::garments_test {

namespace {

struct Path {
    double scattered = 0;  // share of the springs, in the order that the sweep takes
    bool stars = false;    // whether all of them are in stars
};

/// The path of a step through the springs of a mesh in examples/data.
template <class Scalar>
Path path_of(const std::string& name) {
    const auto folder = std::filesystem::path(__FILE__).parent_path() / "../../examples/data";
    const auto mesh = example::read_obj((folder / name).string());
    const auto springs = taut::springs_from_mesh<Scalar>(
        taut::Points<Scalar, 3>(mesh.vertices.cast<Scalar>()), mesh.faces);
    taut::Buffer<taut::step_detail::SpringEnds> ends;
    springs.system.for_each_set([&](const auto& set) { ends.push_back({set.a, set.b}); });
    const auto order = taut::step_detail::Planner<Scalar>::order(
        ends, taut::step_detail::Blocks(springs.system.size()), true);
    std::size_t scattered = 0;
    for (std::size_t law = 0; law < ends.size(); ++law) {
        scattered += order.laws[law].scattered().size();
    }
    CHECK(springs.unused_vertices == 0);
    return {static_cast<double>(scattered) / static_cast<double>(springs.system.spring_count()),
            order.stars};
}

}  // namespace

TEMPLATE_TEST_CASE("garments: the poncho's springs are in stars, most of the skirt's in runs",
                   "[programs]", float, double) {
    const Path poncho = path_of<TestType>("poncho.obj");
    CHECK(poncho.stars);
    CHECK(poncho.scattered > 0.5);
    CHECK(path_of<TestType>("skirt.obj").scattered < 0.5);
}

}  // namespace taut_test::garments_test
