// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The cape and skirt of examples/cape.cpp on the figure of 14 capsules that walks, runs and turns,
// by Guarded with Contacts and by what a user would pick instead; a ball through a held cloth, a
// cloth at rest on a ball, a figure far from the origin, 10 000 contacts. Prints Markdown; times
// are of one thread's processor. Programs that wear the cape may be named: cape_table.sh does.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cape/ball.hpp"
#include "cape/bullet_on_bodies.hpp"
#include "cape/frames.hpp"
#include "cape/judge.hpp"
#include "cape/program_wears.hpp"
#include "cape/resting.hpp"
#include "cape/taut_wears.hpp"
#include "cape/xpbd_on_bodies.hpp"
#include "measure.hpp"

namespace {

using bench::Frames;
using bench::Judge;
using taut::Index;

constexpr double budget = 60e3;  // ms of processor that a row may take

// What engines take, what keeps stretch near Taut's, and as many as Taut's.
const std::vector<Index> xpbd_steps{10, 20, 40, 119};
// Its defaults, what a game might take, and what keeps stretch near Taut's.
const std::vector<bench::BulletSettings> bullet_settings{{}, {5, 5, 1, 0.02f}, {10, 10, 1, 0.02f}};

/// A row of the cape's table. @param take  double take(frames): a frame, its ms, < 0 if refused
template <class Take, class At>
void row(const std::string& name, Frames scene, int frames, Take&& take, At&& at) {
    Judge judge(scene.cloth());
    double spent = 0;
    for (int f = 0; f < frames && !judge.lost() && spent < budget; ++f) {
        scene.next();
        const double ms = take(scene);
        spent += std::max(ms, 0.0);
        ms < 0 ? judge.give_up() : judge.see(ms, scene.figure(), at());
    }
    std::printf("| %s | %s |\n", name.c_str(), judge.cells().c_str());
    std::fflush(stdout);
}

/// How long a job takes, ms.
template <class Job>
double timed(Job&& job) {
    const double start = bench::now(bench::thread_time);
    job();
    return bench::now(bench::thread_time) - start;
}

/// @param away  of the figure from the origin, m
std::string taut_row(int frames, float away = 0) {
    const Frames scene(away);
    bench::TautWears taut(scene.cloth(), Frames::bodies(), scene.to());
    const double energy = double(scene.cloth().energy(taut.state()));
    const auto take = [&](const Frames& now) {
        if (taut.frames() == Judge::start) taut.seen().start();
        bool ok = false;
        const double ms = timed([&] { ok = taut.advance(now.to(), now.pins()); });
        return ok ? ms : -1;
    };
    row(
        "Taut, Guarded and Contacts", scene, frames,
        take, [&]() -> const auto& { return taut.state().x; });
    char text[600];
    std::snprintf(
        text, sizeof text,
        "\nTaut, of %d frames of %d steps: %d refused, %d taken again, %d blind. Deepest "
        "between two steps:\n%.3f mm into the 5 mm that are kept above the skin, %.2f mm below the "
        "skin. What is near was looked up\n%d times. The cloth ends with %.2f J of %.2f J; the "
        "bodies did %.2f J of "
        "work.\n",
        taut.frames(), int(taut.substeps()), taut.refused(), taut.again(), taut.blind(),
        1e3 * double(taut.seen().deepest()), std::max(0.0, 1e3 * double(taut.seen().deepest()) - 5),
        int(taut.contacts().lookups()), double(scene.cloth().energy(taut.state())), energy,
        taut.work());
    return text;
}

void xpbd_row(Index steps, int frames, float away = 0) {
    const Frames scene(away);
    bench::XpbdOnBodies xpbd(scene.cloth(), steps, Frames::bodies());
    row(
        "XPBD, small steps: " + std::to_string(steps), scene, frames,
        [&](const Frames& now) {
            return timed([&] { xpbd.advance(now.from(), now.to(), now.pins()); });
        },
        [&]() -> const auto& { return xpbd.state().x; });
}

void bullet_row(const bench::BulletSettings& settings, int frames) {
    const Frames scene;
    const bench::Net net = bench::net_of(scene.cloth());
    bench::BulletOnBodies bullet(net, settings, Frames::bodies(), scene.to());
    row(
        "Bullet soft body: " + settings.name(), scene, frames,
        [&](const Frames& now) {
            return timed([&] { bullet.advance(now.from(), now.to(), now.pins()); });
        },
        [&] { return taut::Points<float, 3>(bullet.state().x.cast<float>()); });
}

void program_row(const std::string& name, const std::string& command, const std::string& scene,
                 int frames) {
    bench::ProgramWears program(command, scene, bench::garments.size());
    row(
        name, Frames(), frames,
        [&](const Frames&) { return program.advance() ? program.ms() : -1; },
        [&] { return program.x(); });
}

using Program = std::pair<std::string, std::string>;  // name, command

void cape_table(int frames, const std::vector<Program>& programs) {
    std::printf(
        "## Cape and skirt on the running figure, %.0f s\n\n"
        "%d particles, %d springs of 1 000 N/m that only pull, %d of 2 N/m; 14 capsules that are "
        "kept away by 5 mm,\nfriction 0.3, drag 1/s; all in float, on one core. Seen after half a "
        "second, when the skirt, which begins\ninside the thighs, is out; where a row has taken "
        "%.0f s of processor it ends. Deepest: below the skin at\na frame's end. l/L: of the "
        "springs of 1 000 N/m, of all frames. Fastest: a particle's way in a frame.\nExploded: "
        "more than 10 m in a frame.\n\n| | %s |\n|---|%s|\n",
        double(bench::frame) * frames, int(bench::garments.size()),
        int(Frames().cloth().springs<taut::TensionOnly>().size()),
        int(Frames().cloth().springs<taut::Hookean>().size()), budget / 1e3, Judge::columns,
        Judge::rule);
    const std::string more = taut_row(frames);
    for (const Index steps : xpbd_steps) xpbd_row(steps, frames);
    for (const auto& settings : bullet_settings) bullet_row(settings, frames);
    if (!programs.empty()) {
        const auto scene = std::filesystem::temp_directory_path() / "taut_cape_scene.bin";
        if (!bench::write_scene(scene.string(), frames)) std::exit(1);
        for (const auto& [name, command] : programs)
            program_row(name, command, scene.string(), frames);
        std::filesystem::remove(scene);
    }
    std::printf("%s", more.c_str());
}

void far_table(int frames) {
    std::printf(
        "\n## The same with the figure 1 km from the origin, in float, %.0f s\n\n| | %s |\n"
        "|---|%s|\n",
        double(bench::frame) * frames, Judge::columns, Judge::rule);
    const std::string more = taut_row(frames, 1000);
    xpbd_row(20, frames, 1000);
    std::printf("%s", more.c_str());
}

}  // namespace

/// Arguments: how long, 60 s unless given, and names and commands of programs that wear the cape.
int main(int argc, char** argv) try {
    char* end = nullptr;
    const double seconds = argc > 1 ? std::strtod(argv[1], &end) : 60;
    if ((end && *end) || !(seconds >= 1 && seconds <= 3600) || (argc > 2 && argc % 2 == 1)) {
        std::fprintf(stderr, "cape_table [SECONDS [NAME COMMAND]...], 1 to 3600 s\n");
        return 2;
    }
    std::vector<Program> programs;
    for (int i = 2; i + 1 < argc; i += 2) programs.emplace_back(argv[i], argv[i + 1]);
    const int frames = int(60 * seconds);
    cape_table(frames, programs);
    bench::ball_table(xpbd_steps, bullet_settings);
    bench::resting_table(xpbd_steps, bullet_settings);
    far_table(std::min(frames, 600));
    bench::many_contacts();
} catch (const std::exception& error) {
    std::fprintf(stderr, "cape_table: %s\n", error.what());
    return 1;
}
