// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/time.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "judge.hpp"
#include "once_false.hpp"

// The search for a false certificate or refutation, as the programs run it.

namespace soundness {

/// Ends the program where a scene takes longer than two minutes of processor time, with its name:
/// an endless loop is a defect too.
class Watch {
public:
    explicit Watch(const std::string& scene) {
        watched_ = &scene;
        std::signal(SIGPROF, [](int) {
            std::printf("ENDLESS: %s\n", watched_->c_str());
            std::fflush(stdout);
            std::_Exit(1);
        });
        allow(120);
    }
    ~Watch() { allow(0); }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

private:
    static void allow(long seconds) {
        const itimerval time{{0, 0}, {seconds, 0}};
        setitimer(ITIMER_PROF, &time, nullptr);
    }
    static inline const std::string* watched_ = nullptr;
};

/// Judges the spring scene, or the linear system, of a seed. @returns false if it was refused
inline bool judge_seed(bool springs, std::uint32_t seed, Tally& tally) {
    Draw draw(seed);
    const Index kind = draw.below(5);
    tally.scene = std::string(springs ? "--springs" : "--linear") + " --seed " +
                  std::to_string(seed) + " --count 1, " + name(draw.range());
    const auto say = [&](const char* what) { tally.scene += std::string(", ") + what; };
    const Watch watch(tally.scene);
    try {
        if (springs) {
            switch (kind) {
                case 0:
                    say("1-D");
                    judge_springs<Springs<double, 1>>(draw, tally);
                    break;
                case 1:
                    say("3-D, float");
                    judge_springs<Springs<float, 3>>(draw, tally);
                    break;
                case 2:
                    say("3-D");
                    judge_springs<Springs<double, 3>>(draw, tally);
                    break;
                default: say("2-D"); judge_springs<Springs<double, 2>>(draw, tally);
            }
        } else if (kind == 0) {
            say("from springs");
            const auto scene = random_scene<Springs<double, 2>>(draw);
            judge_matrices(draw, tally, taut::linearize(scene.system, scene.state));
        } else if (kind == 1) {
            say("float");
            judge_matrices(draw, tally, random_linear<float>(draw));
        } else {
            judge_matrices(draw, tally, random_linear<double>(draw));
        }
    } catch (const std::invalid_argument&) {
        return false;
    }
    return true;
}

/// How much to search.
struct Search {
    std::uint32_t seed = 1;
    int count = 0;       ///< of each sort; 0: as many as fit into `seconds`
    double seconds = 0;  ///< 0: however long `count` takes
    bool springs = true;
    bool linear = true;
};

/// Prints what is false as it is found, then a table. @returns how many claims are false
inline int run(const Search& search) {
    const auto begin = std::chrono::steady_clock::now();
    const auto late = [&] {
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
        return search.seconds > 0 && passed.count() > search.seconds;
    };
    Tally tally;
    int judged[2] = {0, 0};
    int refused[2] = {0, 0};
    const auto judge = [&](bool springs, std::uint32_t seed) {
        const bool accepted = judge_seed(springs, seed, tally);
        ++(accepted ? judged : refused)[springs];
        return accepted;
    };
    if (search.count != 1) {
        for (const std::uint32_t seed : once_false_springs) judge(true, seed);
        for (const std::uint32_t seed : once_false_linear) judge(false, seed);
    }
    std::uint32_t seed = search.seed;
    int left = search.count > 0 ? search.count : -1;
    for (int found = 0; found != left && !late(); ++seed) {
        bool any = false;
        if (search.springs) any = judge(true, seed) || any;
        if (search.linear) any = judge(false, seed) || any;
        found += any || left == 1;
    }
    std::printf(
        "\n## The referee: seeds %u to %u\n\n%d spring scenes (%d refused), %d linear "
        "systems (%d refused)\n\n| claim | judged | false | unknown |\n|---|---|---|---|\n",
        search.seed, seed - 1, judged[1], refused[1], judged[0], refused[0]);
    for (const auto& [claim, count] : tally.claims) {
        std::printf("| %s | %d | %d | %d |\n", claim.c_str(), count.judged, count.wrong,
                    count.unknown);
    }
    return tally.wrong;
}

/// The options of a command line: --seed N, --count N or --seconds N, --springs or --linear for one
/// sort alone. @returns the exit code: 0 if nothing was false
inline int search_main(int argc, char** argv) {
    Search search;
    bool only_springs = false;
    bool only_linear = false;
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char* option) { return std::strcmp(argv[i], option) == 0; };
        const auto number = [&] { return i + 1 < argc ? std::atof(argv[++i]) : 0; };
        if (is("--seed")) {
            search.seed = static_cast<std::uint32_t>(number());
        } else if (is("--count")) {
            search.count = static_cast<int>(number());
        } else if (is("--seconds")) {
            search.seconds = number();
        } else if (is("--springs")) {
            only_springs = true;
        } else if (is("--linear")) {
            only_linear = true;
        } else {
            std::fprintf(stderr, "soundness: unknown option '%s'\n", argv[i]);
            return 2;
        }
    }
    search.springs = !only_linear;
    search.linear = !only_springs;
    if (!(search.count > 0) && !(search.seconds > 0)) {
        std::fprintf(stderr, "soundness: say --count or --seconds\n");
        return 2;
    }
    return run(search) > 0 ? 1 : 0;
}

}  // namespace soundness
