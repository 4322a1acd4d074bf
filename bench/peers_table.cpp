// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a user would pick instead, on the hanging cloth and on a mesh: what a frame of 1/60 s costs,
// how near it is to the converged motion and what becomes of the scene. Prints Markdown; times are
// of one thread's processor.

#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/taut.hpp>
#include <taut/scene/mesh.hpp>
#include <utility>
#include <vector>

#include "accuracy.hpp"
#include "bullet.hpp"
#include "measure.hpp"
#include "mesh_in.hpp"
#include "odeint.hpp"
#include "outcome.hpp"
#include "xpbd.hpp"

namespace {

using bench::Net;
using taut::Index;

constexpr double frame = 1.0 / 60;  // s
constexpr double budget = 20e3;     // ms of processor that a row may take

/// A stepper of Taut's with its state, in `substeps` a frame.
template <class Stepper>
class Ours {
public:
    explicit Ours(const Net& net, Index substeps = 1)
        : stepper_(net), state_(net.initial_state()), substeps_(substeps) {}
    Index advance(double duration) {
        const double h = duration / static_cast<double>(substeps_);
        return stepper_.step(state_, h, substeps_) ? substeps_ : 0;
    }
    const Net::State& state() const { return state_; }

private:
    Stepper stepper_;
    Net::State state_;
    Index substeps_;
};

/// Whole frames by the guard, its first frame with the limits included.
class Guard {
public:
    explicit Guard(const Net& net) : guard_(net), state_(net.initial_state()) {}
    Index advance(double duration) {
        const auto report = guard_.advance(state_, duration);
        return report ? report.substeps : 0;
    }
    const Net::State& state() const { return state_; }

private:
    taut::Guarded<taut::VelocityVerlet<Net>> guard_;
    Net::State state_;
};

class Odeint : bench::OdeintSymplectic {
public:
    Odeint(const Net& net, Index substeps) : OdeintSymplectic(net), substeps_(substeps) {}
    Index advance(double duration) {
        step(duration / static_cast<double>(substeps_), substeps_);
        return substeps_;
    }
    using OdeintSymplectic::state;

private:
    Index substeps_;
};

class Xpbd : bench::Xpbd {
public:
    Xpbd(const Net& net, Index substeps, Order order = Order::coloured)
        : bench::Xpbd(net, frame / static_cast<double>(substeps), order), substeps_(substeps) {}
    Index advance(double) {
        step(substeps_);
        return substeps_;
    }
    using bench::Xpbd::state;

private:
    Index substeps_;
};

/// A second of free swing, or as much of it as the budget allows.
template <class Peer>
void row(const std::string& name, const bench::Reference& reference, Peer&& peer) {
    bench::Outcome outcome(reference.net());
    bench::Accuracy accuracy(reference);
    bench::Stopwatch watch(bench::thread_time);
    const double start = bench::now(bench::thread_time);
    Index steps = 0;
    int frames = 0;
    while (frames < 60 && !outcome.lost() && bench::now(bench::thread_time) - start < budget) {
        Index taken = 0;
        watch.run([&] { taken = peer.advance(frame); });
        steps += taken;
        ++frames;
        if (taken == 0) {
            outcome.explode();
        } else {
            outcome.see(frames * frame, peer.state());
            accuracy.see(peer.state());
        }
    }
    const auto times = watch.times();
    const double per_frame = static_cast<double>(steps) / frames;
    std::printf("| %s | %.4g | %.4g | %.2f (%.2f) | %.2f | %s | %s |\n", name.c_str(), per_frame,
                times.median / per_frame, times.least, times.median, frames * frame,
                accuracy.cell().c_str(), outcome.cells().c_str());
    std::fflush(stdout);
}

void xpbd_rows(const bench::Reference& reference, Index explicit_substeps) {
    const Net& net = reference.net();
    const auto name = [](Index substeps) {
        return "XPBD, small steps: " + std::to_string(substeps);
    };
    row(name(20) + ", springs as given", reference, Xpbd(net, 20, bench::Xpbd::Order::given));
    for (const Index substeps : {Index(10), Index(20), Index(40)}) {
        row(name(substeps), reference, Xpbd(net, substeps));
    }
    row(name(explicit_substeps) + ", as many", reference, Xpbd(net, explicit_substeps));
    row(name(4 * explicit_substeps) + ", four times as many", reference,
        Xpbd(net, 4 * explicit_substeps));
}

/// @param stretch, bend  stiffness of the net's springs, N/m
void table(const std::string& name, const Net& net, double stretch, double bend) {
    const double limit = taut::any_pose_limit(net).certified;
    const auto substeps = static_cast<Index>(std::ceil(frame / (0.95 * limit)));
    std::printf(
        "## %s\n\n"
        "| | steps a frame | step, ms | frame, ms: min (median) | seen, s | %s | %s |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        name.c_str(), bench::Accuracy::column, bench::Outcome::columns);
    const bench::Reference reference(net, frame, substeps);
    row("Taut SymplecticEuler, 0.95 of the any-pose limit", reference,
        Ours<taut::SymplecticEuler<Net>>(net, substeps));
    row("Taut VelocityVerlet, the same step", reference,
        Ours<taut::VelocityVerlet<Net>>(net, substeps));
    row("Taut Guarded, frames of its own steps", reference, Guard(net));
    xpbd_rows(reference, substeps);
    row("Boost.odeint symplectic_euler, the same step", reference, Odeint(net, substeps));
    row("Boost.odeint runge_kutta_dopri5, error 1e-4", reference, bench::OdeintDopri5(net, 1e-4));
    row("Bullet soft body, 10 position iterations", reference, bench::BulletSoftBody(net, 10));
    row("Bullet deformable, implicit mass-spring force", reference,
        bench::BulletDeformable(net, stretch, bend));
    row("Taut ImplicitEuler, ConjugateGradient 1e-3", reference,
        Ours<taut::ImplicitEuler<Net, taut::ConjugateGradient<double, 3>>>(net));
    row("Taut ProjectiveDynamics, 10 iterations", reference,
        Ours<taut::ProjectiveDynamics<Net>>(net));
    std::printf("\n");
}

}  // namespace

/// Arguments: sizes of the cloth, 32 64 if there are none, and meshes in OBJ form.
int main(int argc, char** argv) try {
    std::vector<Index> sizes;
    std::vector<std::pair<std::string, taut::SpringSystem<double, 3>>> meshes;
    for (int i = 1; i < argc; ++i) {
        const std::string_view text = argv[i];
        Index size = 0;
        const auto read = std::from_chars(text.data(), text.data() + text.size(), size);
        if (read.ec == std::errc() && read.ptr == text.data() + text.size()) {
            sizes.push_back(size);
        } else {
            meshes.emplace_back(bench::file_name(argv[i]),
                                bench::mesh_in<double>(example::read_obj(argv[i])).system);
        }
    }
    std::printf(
        "# Peers: a second of free swing in frames of 1/60 s\n\n"
        "The error is that of the positions beside a converged run, root mean square over "
        "particles and the\nframes of the first 0.2 s, relative to the largest way of a particle. "
        "Energy drift is (mean energy of\nthe last 0.1 s − that of the start) over the largest "
        "kinetic energy, by SpringSystem::energy for all,\nseen once a frame; below 0, energy is "
        "lost. Exploded: a number is not finite, or a spring is longer than\n%.0f times its rest "
        "length. A row that has taken %.0f s ends there.\n\n",
        bench::Outcome::explosion, budget / 1e3);
    for (const Index n : sizes.empty() ? std::vector<Index>{32, 64} : sizes) {
        const taut::ClothOptions options{n, n};
        table("hanging_cloth " + std::to_string(n), taut::hanging_cloth<double>(options),
              options.stretch, options.bend);
    }
    for (const auto& [name, system] : meshes) {
        const taut::MeshOptions options;
        table(name, system, options.stretch, options.bend);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "peers_table: %s\n", error.what());
    return 1;
}
