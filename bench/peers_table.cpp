// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a user would pick instead, on the hanging cloth: what a frame of 1/60 s costs and what
// becomes of the scene. Prints Markdown; times are of one thread's processor.

#include <cstdio>
#include <cstdlib>
#include <taut/integrator/projective_dynamics.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "bullet.hpp"
#include "measure.hpp"
#include "odeint.hpp"
#include "outcome.hpp"

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

/// A second of free swing, or as much of it as the budget allows.
template <class Peer>
void row(const char* name, const Net& net, Peer&& peer) {
    bench::Outcome outcome(net);
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
        }
    }
    const auto times = watch.times();
    const double per_frame = static_cast<double>(steps) / frames;
    std::printf("| %s | %.4g | %.4g | %.2f (%.2f) | %.2f | %s |\n", name, per_frame,
                times.median / per_frame, times.least, times.median, frames * frame,
                outcome.cells().c_str());
    std::fflush(stdout);
}

void table(Index n) {
    const Net cloth = taut::hanging_cloth<double>({n, n});
    const taut::ClothOptions options;
    const double limit = taut::any_pose_limit(cloth).certified;
    const auto substeps = static_cast<Index>(std::ceil(frame / (0.95 * limit)));
    std::printf(
        "## hanging_cloth %d\n\n"
        "| | steps a frame | step, ms | frame, ms: min (median) | seen, s | %s |\n"
        "|---|---|---|---|---|---|---|---|\n",
        static_cast<int>(n), bench::Outcome::columns);
    row("Taut SymplecticEuler, 0.95 of the any-pose limit", cloth,
        Ours<taut::SymplecticEuler<Net>>(cloth, substeps));
    row("Boost.odeint symplectic_euler, the same step", cloth, Odeint(cloth, substeps));
    row("Boost.odeint runge_kutta_dopri5, error 1e-4", cloth, bench::OdeintDopri5(cloth, 1e-4));
    row("Bullet soft body, 10 position iterations", cloth, bench::BulletSoftBody(cloth, 10));
    row("Bullet deformable, implicit mass-spring force", cloth,
        bench::BulletDeformable(cloth, options.stretch, options.bend));
    row("Taut ImplicitEuler, ConjugateGradient 1e-3", cloth,
        Ours<taut::ImplicitEuler<Net, taut::ConjugateGradient<double, 3>>>(cloth));
    row("Taut ProjectiveDynamics, 10 iterations", cloth,
        Ours<taut::ProjectiveDynamics<Net>>(cloth));
    std::printf("\n");
}

}  // namespace

/// Arguments: sizes of the cloth; 32 64 100 if there are none.
int main(int argc, char** argv) {
    std::vector<Index> sizes;
    for (int i = 1; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
    std::printf(
        "# Peers: a second of free swing in frames of 1/60 s\n\n"
        "Energy drift is |mean energy of the last 0.1 s − that of the start| over the largest "
        "kinetic energy,\nby SpringSystem::energy for all, seen once a frame. Exploded: a number "
        "is not finite, or a spring is\nlonger than %.0f times its rest length. A row that has "
        "taken %.0f s ends there.\n\n",
        bench::Outcome::explosion, budget / 1e3);
    for (const Index n : sizes.empty() ? std::vector<Index>{32, 64, 100} : sizes) table(n);
}
