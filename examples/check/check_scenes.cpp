// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Holds what a program of examples/scenes prints against mechanics that know nothing of springs'
// steps: statics, a pendulum, a pressed block.
//
// check_scenes NAME FILE [FACTOR]: exits with 0 if the file, what NAME printed, is within the
// tolerance, its measured number multiplied by the factor; with 1 if not.

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Numbers = std::vector<double>;
constexpr double gravity = 9.81;  // m/s²

/// Whether a measured number is within a tolerance of the expected one; says so.
bool near(const char* what, double measured, double expected, double tolerance) {
    const bool holds = std::abs(measured - expected) <= tolerance;
    std::printf("%s: %.5f, expected %.5f within %.5f%s\n", what, measured, expected, tolerance,
                holds ? "" : ": FAILS");
    return holds;
}

/// The numbers that a pattern holds in a text; empty if it does not occur.
Numbers numbers(const std::string& text, const std::string& pattern) {
    const std::string number = "(-?[0-9.]+(?:e[-+]?[0-9]+)?)";
    std::smatch found;
    Numbers values;
    const std::regex wanted(std::regex_replace(pattern, std::regex("#"), number));
    if (!std::regex_search(text, found, wanted)) return values;
    for (std::size_t i = 1; i < found.size(); ++i) values.push_back(std::stod(found[i]));
    return values;
}

/// The x of a function that rises through 0 between two ends.
double root(double low, double high, const std::function<double(double)>& rising) {
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (rising(middle) < 0 ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// How far down joint `joint` of a hanging chain of elastic links is, m: every link points along
/// the force in it, whose horizontal part is the same in all, and whose vertical part changes by
/// the weight of each joint.
/// @param weights  N, of the joints between the posts
double chain_sag(const Numbers& weights, double span, double link, double stiffness,
                 std::size_t joint) {
    double horizontal = 0;
    const auto walk = [&](double vertical, std::size_t links) {
        std::array<double, 2> at{0, 0};  // across and down, m
        for (std::size_t i = 0; i < links; ++i) {
            const double tension = std::hypot(horizontal, vertical);
            const double length = link * (1 + tension / (stiffness * link));
            at[0] += length * horizontal / tension;
            at[1] += length * vertical / tension;
            if (i < weights.size()) vertical -= weights[i];
        }
        return at;
    };
    const std::size_t links = weights.size() + 1;
    double all = 0, vertical = 0;
    for (const double weight : weights) all += weight;
    root(1, 1e6, [&](double tried) {  // a tighter chain spans more
        horizontal = tried;
        vertical = root(0, all, [&](double v) { return walk(v, links)[1]; });
        return walk(vertical, links)[0] - span;
    });
    return walk(vertical, joint)[1];
}

/// Four ropes of 36 links, 12.2 m long, that sag alike: 6.4 kg a joint, 150 kg at the twelfth.
bool bridge(const Numbers& n) {
    Numbers weights(35, 6.4 * gravity);
    weights[11] += 150 * gravity;
    const double k = 4 * 36 * 50e3;  // N/m of a link of all four
    return near("m, at the load", n[0], chain_sag(weights, 12, 12.2 / 36, k, 12), 0.005) &&
           near("m, in the middle", n[1], chain_sag(weights, 12, 12.2 / 36, k, 18), 0.005);
}

/// What hangs in the air or on its pins is carried by them, in the mean.
bool flag(const Numbers& n) {
    return near("N, carried", n[0] + n[1], n[2] * gravity, 0.03 * n[2] * gravity);
}
bool net(const Numbers& n) {
    return near("N, carried", n[0], n[1] * gravity, 0.02 * n[1] * gravity) &&
           near("m, the ball below the net's edge", n[2], 0.1, 0.09);
}
bool curtain(const Numbers& n) {
    return near("N, carried", n[0], n[1] * gravity, 1e-3 * n[1] * gravity);
}

/// T = 2π√(I/(mgl))/agm(1, cos(θ/2)) of a bob of 0.1 kg on a strand of 30 links: particles of 0.1 g
/// at each joint, stretched by the bob's weight.
bool rope(const Numbers& n) {
    double inertia = 0.1, moment = 0.1;  // of length 1: Σ m s² and Σ m s
    for (int i = 1; i < 30; ++i) {
        inertia += 1e-4 * (i / 30.0) * (i / 30.0);
        moment += 1e-4 * i / 30.0;
    }
    const double length = n[0] + moment * gravity / 1000;
    double a = 1, b = std::cos(n[1] / 2);
    for (int i = 0; i < 9; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    const double turn = 2 * std::acos(-1.0);
    const double period = turn * std::sqrt(length * inertia / (moment * gravity)) / a;
    return near("s, period", n[2], period, 1e-3 * period);
}

/// A block of 7³ particles pressed by its own weight. Of n particles along an edge a layer of
/// springs that is shortened by the share ε and widened by e has, over ½ka²,
/// n²ε² + 2n²e² + 2n(n − 1)(ε − e)² + 4n(n − 1)e²: upright, level and diagonal springs.
bool soft_cube(const Numbers& n) {
    const double edge = 7, a = 0.05, k = 300, weight = edge * edge * edge * 0.01 * gravity;
    const double wider = (edge - 1) / (edge + 3 * (edge - 1));  // e/ε of the least energy
    const double layer =
        k * (edge * edge * (1 + 2 * wider * wider) +
             2 * edge * (edge - 1) * ((1 - wider) * (1 - wider) + 2 * wider * wider));  // N/m
    double sag = 0;
    for (int above = 1; above < 7; ++above) sag += above / edge * weight / layer;
    return near("m, lowest over the floor", n[0], 0, 5e-5) &&
           near("m, pressed by its weight", 6 * a - n[1], sag, 0.2 * sag);
}

/// No force from outside does work on a thrown cloth, so the guard promises at most 0.1 of the
/// kinetic energy more; it keeps 3 % here, both ways. The other step is within the limit at rest,
/// above that of any pose, and its energy grows more than tenfold, then overflows.
bool thrown(const Numbers& n) {
    const double at_rest = n[0], any_pose = n[1], by_hand = n[3], guard_h = n[9];  // ms
    const double before = 0.5 * 0.3 * 4094 / 4096 * 20 * 20;                       // J
    const bool steps = by_hand < at_rest && by_hand > any_pose && guard_h < any_pose;
    const bool explodes = n[5] > 10 * before && n[7] > n[6] && n[7] <= 60;
    if (!steps) std::puts("steps and limits: FAILS");
    if (!explodes) std::puts("the unguarded cloth explodes: FAILS");
    return near("J, thrown", n[4], before, 0.01) && near("J, thrown", n[10], before, 0.01) &&
           near("J, guarded, after 60 frames", n[13], before, 0.03 * before) && steps && explodes;
}

struct Fact {
    const char* printed;
    bool (*holds)(const Numbers&);
    std::size_t measured;  // which of the numbers
};
const std::map<std::string, Fact> facts{
    {"bridge", {"deck is # m down at the load and # m in the middle", bridge, 0}},
    {"curtain", {"rings carry # N of # kg", curtain, 0}},
    {"flag", {"pole carries # N and the air # N of # kg", flag, 0}},
    {"net", {"pins carry # N of # kg, the ball is # m down", net, 0}},
    {"rope", {"strand of # m, let go at # rad, has a period of # s", rope, 2}},
    {"soft_cube", {"lowest # m above the floor, at rest # m high", soft_cube, 1}},
    {"thrown",
     {"proved: about # ms at rest, about # ms at any pose\n"
      "symplectic Euler, # steps of # ms a frame: # J become # J in frame #, not finite in frame "
      "#\n"
      "Guarded, # steps of # ms a frame: # J become # J in frame #, # J in frame 60",
      thrown, 13}}};

}  // namespace

int main(int count, char** arguments) {
    const auto fact = count == 3 || count == 4 ? facts.find(arguments[1]) : facts.end();
    if (fact == facts.end()) return std::puts("usage: check_scenes NAME FILE [FACTOR]"), 2;
    std::ifstream file(arguments[2]);
    std::ostringstream text;
    text << file.rdbuf();
    Numbers printed = numbers(text.str(), fact->second.printed);
    if (printed.empty()) return std::printf("no \"%s\"\n", fact->second.printed), 2;
    if (count == 4) printed[fact->second.measured] *= std::stod(arguments[3]);
    return fact->second.holds(printed) ? 0 : 1;
}
