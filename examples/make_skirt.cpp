// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Writes examples/data/skirt.obj: a pleated conical tube of triangles, in metres, y up, waist at
// y = 0. Vertices go ring by ring from the waist down, so the waist ring is vertices
// 0 .. columns - 1, counted from 0 as `--pin` does.

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <string>

#include "common/main.hpp"
#include "common/output_text.hpp"

// Rounded to a micrometre, so that no digit hangs on the mathematics library; never -0.
static double rounded(double metres) { return std::round(metres * 1e6) / 1e6 + 0.0; }

int main(int argc, char** argv) {
    int columns = 64;
    int rows = 48;
    std::string output;

    CLI::App app{"Writes a skirt-like tube as an OBJ mesh (metres, y up, waist at y = 0)."};
    app.add_option("--columns", columns, "vertices around the waist")
        ->check(CLI::Range(3, 2000))
        ->capture_default_str();
    app.add_option("--rows", rows, "rings of vertices, waist and hem included")
        ->check(CLI::Range(2, 2000))
        ->capture_default_str();
    app.add_option("--output", output, "the OBJ file to write")->required();
    CLI11_PARSE(app, argc, argv)

    constexpr double two_pi = 6.283185307179586;
    constexpr double waist_radius = 0.35;  // m
    constexpr double hem_radius = 0.55;    // m, mean over the pleats
    constexpr double height = 0.60;        // m, waist to hem
    constexpr double pleats = 8.0;         // waves around the tube
    constexpr double pleat_depth = 0.07;   // of the radius at the hem; none at the waist

    const std::string count = std::to_string(columns);
    std::string text = "# pleated skirt, metres, y up; the waist ring is the first " + count +
                       " vertices\n# made by: make_skirt --columns " + count + " --rows " +
                       std::to_string(rows) + "\n";
    char line[128];
    for (int r = 0; r < rows; ++r) {
        const double s = static_cast<double>(r) / (rows - 1);  // 0 at the waist, 1 at the hem
        const double mean = waist_radius + (hem_radius - waist_radius) * s;
        for (int c = 0; c < columns; ++c) {
            const double angle = two_pi * c / columns;
            const double radius = mean * (1.0 + pleat_depth * s * std::cos(pleats * angle));
            std::snprintf(line, sizeof line, "v %.6g %.6g %.6g\n",
                          rounded(radius * std::cos(angle)), rounded(-height * s),
                          rounded(radius * std::sin(angle)));
            text += line;
        }
    }
    for (int r = 0; r + 1 < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const int a = r * columns + c + 1;  // OBJ counts from 1
            const int b = r * columns + (c + 1) % columns + 1;
            const int d = a + columns;           // below a
            const int e = b + columns;           // below b
            const bool even = (r + c) % 2 == 0;  // the diagonal is a-e or b-d in turns
            std::snprintf(line, sizeof line, "f %d %d %d\nf %d %d %d\n", a, b, even ? e : d,
                          even ? a : b, e, d);
            text += line;
        }
    }
    text.pop_back();  // write_text ends the last line
    return example::guarded_main("make_skirt", [&] {
        example::write_text(text, "--output", output);
        return 0;
    });
}
