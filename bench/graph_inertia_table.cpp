// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Graph inertia [T33]: what it costs beside the explicit step and how far it errs, whether what is
// certified is stable, by how much the energy that it keeps exceeds the start, whether it rises at
// all at the dial's end [T35], what the dial does on the way, and whether the price that is told is
// the price. Prints Markdown; exits with 1 where something that is proved does not hold.
// Arguments: parts to run, of price, stable, kept, networks, modes, dial (all); meshes in OBJ form
// to add to the price table; --motions N, --seconds S, --margin θ, --dissipation δ for `kept`.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "graph_inertia/kept.hpp"
#include "graph_inertia/modes.hpp"
#include "graph_inertia/networks.hpp"
#include "graph_inertia/price.hpp"
#include "graph_inertia/stable.hpp"

namespace {

using namespace bench::graph_inertia;

struct Arguments {
    std::vector<std::string> parts, meshes;
    int motions = 200;
    double seconds = 60;
    std::vector<double> margins, dissipations;

    bool has(const char* part) const {
        return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
    }
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.size() > 4 && word.substr(word.size() - 4) == ".obj") {
            arguments.meshes.push_back(word);
        } else if (word.substr(0, 2) == "--" && i + 1 < argc) {
            const double value = std::atof(argv[++i]);
            if (word == "--motions") arguments.motions = static_cast<int>(value);
            if (word == "--seconds") arguments.seconds = value;
            if (word == "--margin") arguments.margins.push_back(value);
            if (word == "--dissipation") arguments.dissipations.push_back(value);
        } else {
            arguments.parts.push_back(word);
        }
    }
    return arguments;
}

void print_prices(const Arguments& arguments) {
    std::printf(
        "## A frame of 1/60 s, explicit and by graph inertia\n\n"
        "Ratio: of the least times of a frame, one thread. Error: beside velocity Verlet at a "
        "quarter of the certified step, over 0.5 s (garments 0.25 s), of the largest way of a "
        "particle. Added: inertia, of the mass. Bold: the cheapest within the scene's bound.\n\n"
        "| scene | steps | touched | prepare, ms | frame, ms | ratio | rms, %% | largest, %% | "
        "added, %% |\n|---|---|---|---|---|---|---|---|---|\n");
    const taut::GraphInertiaOptions options;
    price_scene({"hem × 1000", hem(64, 1000), 0.003}, options);
    price_scene({"patch × 100", patch(64, 100), 0.01}, options);
    price_scene({"seam × 1000", seam(64, 1000), 0.01}, options);
    price_scene({"seam × 100", seam(64, 100), 0.01}, options);
    price_scene({"net, rope × 1000", roped_net(64, 1000), 0.01}, options);
    price_scene({"hanging_cloth 100", taut::hanging_cloth<double>({100, 100}), 0.02}, options);
    Random random(7);
    price_scene({"rough tube", garment(rough_tube(32, 22, random), 100), 0.02, 15}, options);
    for (const auto& mesh : arguments.meshes) {
        price_scene({mesh, garment(example::read_obj(mesh), 1000), 0.02, 15}, options);
    }
    std::printf("\n");
}

void print_kept(const Arguments& arguments) {
    std::printf(
        "## The energy that is kept\n\n"
        "%d cloths, nets and garments, hung, dropped, waved or thrown, %g s each, at 2 to 20 times "
        "the any-pose limit of the explicit step. Excess: over the start and the work of outside, "
        "of kinetic + elastic + work; 60 looks a second. A run whose excess passes 100 %% ends "
        "there.\n\n"
        "| θ | δ | motions | failed | above 1 %% at a look | in the mean of the last second | "
        "largest, %% | largest mean of the last second, %% |\n|---|---|---|---|---|---|---|---|\n",
        arguments.motions, arguments.seconds);
    taut::GraphInertiaOptions options;
    const auto margins =
        arguments.margins.empty() ? std::vector<double>{options.margin} : arguments.margins;
    const auto dissipations = arguments.dissipations.empty()
                                  ? std::vector<double>{0, 0.01, 0.03, 0.1}
                                  : arguments.dissipations;
    for (const double margin : margins) {
        for (const double dissipation : dissipations) {
            options.margin = margin;
            options.dissipation = dissipation;
            kept_row(arguments.motions, arguments.seconds, options);
        }
    }
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
    const auto arguments = parse(argc, argv);
    bool ok = true;
    if (arguments.has("price")) print_prices(arguments);
    if (arguments.has("stable")) ok = stability_table(1000, 100000) && ok;
    if (arguments.has("networks")) ok = networks_table(10000, 200) && ok;
    if (arguments.has("modes")) ok = modes_table() && ok;
    if (arguments.has("dial")) dial_table({});
    if (arguments.has("kept")) print_kept(arguments);
    return ok ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "graph_inertia_table: %s\n", error.what());
    return 2;
}
