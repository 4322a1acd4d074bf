// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What drag and α make of scenes that Guarded keeps sound: how calm they get, what the damping
// takes off the proved step, and how many frames are still trimmed. Prints Markdown. Nothing is
// timed. Arguments: particles along an edge; the file that the figure of docs/calm.md is written
// to.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>
#include <taut/wind/wind.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>
#include <vector>

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3, taut::TensionOnly>;

constexpr double frame = 1.0 / 60;  // s
constexpr int frames = 300, driven = 150;

/// What drives a scene before a frame; `on` is 1, and 0 while it rests.
struct Shaken {
    void operator()(Cloth& cloth, Cloth::State& state, double time, double on) const {
        for (Index i = 0; i < cloth.size(); ++i) {
            if (cloth.is_pinned(i)) state.v(1, i) = on * std::cos(5 * time);
        }
    }
};
struct Blown {
    void operator()(Cloth& cloth, Cloth::State&, double time, double on) const {
        taut::set_wind_velocity(cloth, {6 * on, 0, 2 * on * std::sin(2 * time)});
    }
};

/// Hangs by two corners.
Cloth garment(Index side) {
    return taut::with_law<taut::TensionOnly>(taut::hanging_cloth<double>({side, side}));
}

/// Hangs by its upper edge: no diagonals, nothing that bends.
Cloth net(Index side) {
    taut::ClothOptions options{side, side};
    options.diagonals = false;
    options.bend = 0;
    Cloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<double>(options));
    for (Index i = 0; i < side; ++i) cloth.pin(i);
    return cloth;
}

/// 1.5 m × 1 m at a pole, in the wind and, between gusts, in air at rest.
Cloth flag(Index side) {
    taut::ClothOptions options{2 * side / 3, side};
    options.width = 1.5;
    options.pin_corners = false;
    Cloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<double>(options));
    cloth.set_gravity({0, -9.81, 0});
    for (Index r = 0; r < options.rows; ++r) cloth.pin(r * side);
    taut::Wind<double> wind;
    wind.triangles = taut::cloth_triangles(options);
    taut::set_wind(cloth, wind);
    return cloth;
}

struct Run {
    std::vector<double> kinetic;   ///< after each frame, J
    int trimmed = 0;               ///< or taken again, of the frames that are driven
    double proved = 0, trial = 0;  ///< what is left of either longest step
};

template <class Drive>
Run run(Cloth cloth, const taut::RayleighDamping& damping, Drive drive) {
    const double undamped = taut::energy_limit(cloth).certified;
    const double any_pose = taut::any_pose_limit(cloth).certified;
    cloth.set_rayleigh({damping.mass_proportional, damping.stiffness_proportional * undamped});
    Run result;
    result.proved = taut::energy_limit(cloth).certified / undamped;
    result.trial = taut::any_pose_limit(cloth).certified / any_pose;
    taut::Guarded guard(cloth);
    auto state = cloth.initial_state();
    for (int i = 0; i < frames; ++i) {
        drive(cloth, state, i * frame, i < driven ? 1 : 0);
        const auto report = guard.advance(state, frame);
        if (!report) std::abort();
        result.trimmed += i < driven && report.trimmed + report.again > 0;
        result.kinetic.push_back(cloth.kinetic_energy(state));
    }
    return result;
}

double mean(const std::vector<double>& values, int from, int to) {
    double sum = 0;
    for (int i = from; i < to; ++i) sum += values[static_cast<std::size_t>(i)];
    return sum / (to - from);
}

/// @param damping  d0, 1/s, and α in proved steps
template <class Drive>
Run row(const char* name, const Cloth& cloth, const taut::RayleighDamping& damping, Drive drive) {
    Run result = run(cloth, damping, drive);
    std::printf("| %s | %g | %g | %.2f | %.2f | %d | %.2f | %.2f |\n", name,
                damping.mass_proportional, damping.stiffness_proportional, result.proved,
                result.trial, result.trimmed, mean(result.kinetic, 60, driven),
                mean(result.kinetic, frames - 60, frames));
    std::fflush(stdout);
    return result;
}

struct Curve {
    const char* name;
    const char* colour;
    const char* dashes;
    std::vector<double> kinetic;  // J
};

/// Kinetic energy over time, on a logarithmic scale from 1 mJ to 10 J, as SVG.
void draw(const char* path, const std::vector<Curve>& curves) {
    std::FILE* file = std::fopen(path, "w");
    if (file == nullptr) {
        std::fprintf(stderr, "calm_table: %s cannot be written\n", path);
        std::exit(1);
    }
    const double left = 60, top = 20, width = 440, height = 240;
    const auto across = [&](double time) { return left + width * time / (frames * frame); };
    const auto down = [&](double J) {
        return top + height * (1 - std::log10(std::clamp(J, 1e-3, 10.0)) / 4 - 0.75);
    };
    std::fprintf(file,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 690 300\" width=\"690\" "
                 "height=\"300\" font-family=\"sans-serif\" font-size=\"13\">\n"
                 " <title>Kinetic energy of a cloth that is shaken and then held still</title>\n"
                 " <rect width=\"690\" height=\"300\" fill=\"#ffffff\"/>\n"
                 " <rect x=\"%g\" y=\"%g\" width=\"%.1f\" height=\"%g\" fill=\"#f0f0f0\"/>\n",
                 left, top, across(driven * frame) - left, height);
    for (const double J : {0.001, 0.01, 0.1, 1.0, 10.0}) {
        std::fprintf(file,
                     " <line x1=\"%g\" x2=\"%g\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#cccccc\"/>\n"
                     " <text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%g J</text>\n",
                     left, left + width, down(J), down(J), left - 6, down(J) + 4, J);
    }
    for (int second = 0; second <= 5; ++second) {
        std::fprintf(file, " <text x=\"%.1f\" y=\"%g\" text-anchor=\"middle\">%d s</text>\n",
                     across(second), top + height + 20, second);
    }
    std::fprintf(file,
                 " <text x=\"%g\" y=\"%g\">corners shake</text>\n"
                 " <text x=\"%.1f\" y=\"%g\">corners at rest</text>\n",
                 left + 6, top + height - 8, across(driven * frame) + 6, top + height - 8);
    double line = top + 20;
    for (const Curve& curve : curves) {
        std::fprintf(file,
                     " <polyline fill=\"none\" stroke=\"%s\" stroke-width=\"2\" "
                     "stroke-dasharray=\"%s\" points=\"",
                     curve.colour, curve.dashes);
        for (int i = 0; i < frames; i += 2) {
            std::fprintf(file, "%.1f,%.1f ", across((i + 1) * frame),
                         down(curve.kinetic[static_cast<std::size_t>(i)]));
        }
        std::fprintf(file,
                     "\"/>\n <line x1=\"515\" x2=\"545\" y1=\"%g\" y2=\"%g\" stroke=\"%s\" "
                     "stroke-width=\"2\" stroke-dasharray=\"%s\"/>\n"
                     " <text x=\"552\" y=\"%g\">%s</text>\n",
                     line, line, curve.colour, curve.dashes, line + 4, curve.name);
        line += 24;
    }
    std::fprintf(file, "</svg>\n");
    if (std::fclose(file) != 0) std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
    const Index side = argc > 1 ? std::atoi(argv[1]) : 32;
    std::printf(
        "%d particles along an edge, springs that only pull; driven for 2.5 s, then at rest\n\n"
        "| scene | d0, 1/s | α/h | proved step | trial | of %d "
        "frames trimmed | driven, J | at rest, J |\n|---|---|---|---|---|---|---|---|\n",
        static_cast<int>(side), driven);
    const Cloth cloth = garment(side);
    const std::vector<Curve> curves{
        {"undamped", "#333333", "none", row("garment", cloth, {0, 0}, Shaken{}).kinetic},
        {"α alone", "#b2182b", "2 3", row("garment", cloth, {0, 0.1}, Shaken{}).kinetic},
        {"drag alone", "#1b7837", "8 4", row("garment", cloth, {1, 0}, Shaken{}).kinetic},
        {"drag and α", "#2166ac", "none", row("garment", cloth, {1, 0.1}, Shaken{}).kinetic}};
    row("flag", flag(side), {0, 0}, Blown{});
    row("flag", flag(side), {0, 0.1}, Blown{});
    row("flag", flag(side), {0.2, 0.1}, Blown{});
    row("net", net(side), {0, 0}, Shaken{});
    row("net", net(side), {0.5, 0}, Shaken{});
    row("net", net(side), {0.5, 0.1}, Shaken{});
    row("net", net(side), {0.5, 0.4}, Shaken{});
    const double h = taut::energy_limit(cloth).certified;
    std::printf("\ndamping ratio of the garment: %.2f at 3.1 rad/s, %.3f at 1/h\n",
                taut::damping_ratio({1, 0.1 * h}, 3.1), taut::damping_ratio({1, 0.1 * h}, 1 / h));
    if (argc > 2) draw(argv[2], curves);
}
