// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/tradeoff/trajectory.hpp>

#include "outcome.hpp"

namespace bench {

/// The start of a free swing, converged: velocity Verlet at a tenth of an explicit step, seen at
/// the end of every frame. Later a change of the last bit grows as large as what is measured: the
/// scenes fold and are chaotic.
class Reference {
public:
    static constexpr int frames = 12;  // of 1/60 s: 0.2 s
    using Run = taut::Trajectory<double, 3>;

    /// @param substeps  explicit steps a frame
    Reference(const Net& net, double frame, taut::Index substeps) : net_(&net) {
        taut::VelocityVerlet<Net> stepper(net);
        auto state = net.initial_state();
        run_.see(net, state);
        const taut::Index count = 10 * substeps;
        for (int i = 0; i < frames; ++i) {
            if (!stepper.step(state, frame / static_cast<double>(count), count)) return;
            run_.see(net, state);
        }
    }
    const Net& net() const { return *net_; }
    const Run& run() const { return run_; }

private:
    const Net* net_;
    Run run_;
};

/// How far a run is from the reference: root mean square over particles and frames, relative to the
/// largest way that the reference has gone.
class Accuracy {
public:
    static constexpr const char* column = "error in 0.2 s";

    explicit Accuracy(const Reference& reference) : reference_(reference) {
        run_.see(reference.net(), reference.net().initial_state());
    }
    /// Sees the scene after a frame.
    void see(const Net::State& state) {
        if (run_.x.size() < reference_.run().x.size()) run_.see(reference_.net(), state);
    }
    /// The cell below `column`.
    std::string cell() const {
        const double error = taut::position_error(run_, reference_.run());
        if (!std::isfinite(error)) return "–";
        char text[32];
        std::snprintf(text, sizeof text, "%.2g %%", 100 * error);
        return text;
    }

private:
    const Reference& reference_;
    Reference::Run run_;
};

}  // namespace bench
