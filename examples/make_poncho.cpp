// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Writes examples/data/poncho.obj: a square of cloth with a hole for the neck, laid over a ridge,
// in metres, y up. Like the meshes of garment programs it has no rows: its points lie at random, a
// spacing apart, and its triangles are Delaunay's. The neck is the first vertices. All that decides
// is in whole numbers, so that every machine writes the same bytes.

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/main.hpp"
#include "common/output_text.hpp"

namespace {

using Number = std::int64_t;
using Point = std::array<Number, 2>;  // 0 to side; no determinant of such numbers is too large
using Triangle = std::array<int, 3>;  // anticlockwise

constexpr Number metre = 8192;
constexpr Number side = 3 * metre / 2;
constexpr Number spacing = 200;
constexpr Number neck_radius = 984;  // 0.12 m
constexpr int neck = 30;             // vertices around it
constexpr int hem = 60;              // edges along each side
constexpr Point middle{side / 2, side / 2};

Number squared_distance(const Point& p, const Point& q) {
    return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
}

/// Twice the area of a triangle; above 0 if it is anticlockwise.
Number area(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether p lies inside the circle through a, b and c, which are anticlockwise.
bool in_circle(const Point& a, const Point& b, const Point& c, const Point& p) {
    return squared_distance(a, p) * area(p, b, c) - squared_distance(b, p) * area(p, a, c) +
               squared_distance(c, p) * area(p, a, b) >
           0;
}

/// The neck, the four corners, the rest of the hem, and then as many at random as have room.
std::vector<Point> make_points() {
    std::vector<Point> points;
    for (int i = 0; i < neck; ++i) {
        const double angle = 6.283185307179586 * i / neck;
        points.push_back({middle[0] + std::lround(neck_radius * std::cos(angle)),
                          middle[1] + std::lround(neck_radius * std::sin(angle))});
    }
    for (int i = 0; i < hem; ++i) {
        const Number at = side * i / hem;
        points.insert(points.end(), {{at, 0}, {side, at}, {side - at, side}, {0, side - at}});
    }
    std::mt19937 random(1);
    for (int misses = 0; misses < 1000; ++misses) {
        const Point p{static_cast<Number>(random() % side), static_cast<Number>(random() % side)};
        const bool near = std::any_of(points.begin(), points.end(), [&](const Point& q) {
            return squared_distance(p, q) < spacing * spacing;
        });
        if (near || squared_distance(p, middle) < neck_radius * neck_radius) continue;
        points.push_back(p);
        misses = 0;
    }
    return points;
}

/// The Delaunay triangulation (Bowyer and Watson, 1981): a point takes the place of all triangles
/// whose circle it lies in. All lie in the square of the corners.
std::vector<Triangle> triangulate(const std::vector<Point>& points) {
    std::vector<Triangle> triangles{{neck, neck + 1, neck + 2}, {neck, neck + 2, neck + 3}};
    for (int p = 0; p < static_cast<int>(points.size()); ++p) {
        if (neck <= p && p < neck + 4) continue;
        const auto gone =
            std::stable_partition(triangles.begin(), triangles.end(), [&](const Triangle& t) {
                return !in_circle(points[t[0]], points[t[1]], points[t[2]], points[p]);
            });
        std::set<std::pair<int, int>> around;  // edges of one of them
        for (auto t = gone; t != triangles.end(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const int a = (*t)[k], b = (*t)[(k + 1) % 3];
                if (around.erase({b, a}) == 0) around.insert({a, b});
            }
        }
        triangles.erase(gone, triangles.end());
        for (const auto& [a, b] : around) {
            // None where the point lies on the hem.
            if (area(points[a], points[b], points[p]) > 0) triangles.push_back({a, b, p});
        }
    }
    return triangles;
}

/// So many tenths of a length, in metres, cut to a micrometre.
double in_metres(Number tenths, Number length) {
    return static_cast<double>(tenths * length * 100'000 / metre) / 1e6;
}

}  // namespace

int main(int argc, char** argv) {
    std::string output;
    CLI::App app{"Writes an irregular poncho as an OBJ mesh (metres, y up, the neck at the top)."};
    app.add_option("--output", output, "the OBJ file to write")->required();
    CLI11_PARSE(app, argc, argv)
    const std::vector<Point> points = make_points();
    std::string text = "# poncho, metres, y up; the neck is the first " + std::to_string(neck) +
                       " vertices\n# made by: make_poncho\n";
    char line[128];
    for (const Point& p : points) {
        const Number x = p[0] - middle[0];
        std::snprintf(line, sizeof line, "v %.6g %.6g %.6g\n", in_metres(8, x),
                      in_metres(-6, std::abs(x)), in_metres(10, p[1] - middle[1]));
        text += line;
    }
    for (const Triangle& t : triangulate(points)) {
        if (std::max({t[0], t[1], t[2]}) < neck) continue;  // in the hole
        std::snprintf(line, sizeof line, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
        text += line;
    }
    text.pop_back();  // write_text ends the last line
    return example::guarded_main("make_poncho", [&] {
        example::write_text(text, "--output", output);
        return 0;
    });
}
