// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <taut/graph_inertia/graph_inertia.hpp>

#include "scenes.hpp"

namespace bench::graph_inertia {

/// What graph inertia keeps, ½vᵀM̃v + U + ½h vᵀf − ¼h vᵀDv, and the work of moving pins. Hookean
/// springs without dampers, drag d0; gravity is in U and f, so its work needs no account.
class Kept {
public:
    /// @param dissipation  δ
    Kept(const Net& net, const taut::GraphShares& shares, double h, double dissipation)
        : net_(net), h_(h), drag_(net.rayleigh().mass_proportional) {
        taut::for_each_inertia(net, shares, [&](Index a, Index b, double damped, double elastic) {
            links_.push_back({a, b, damped + elastic, 2 * dissipation * elastic});
        });
        net.visit_springs([&](const auto& spring) {
            springs_.push_back({spring.a, spring.b, spring.stiffness_bound(), spring.rest_length});
        });
        for (const Link& link : links_) {
            if (at_pin(link.a, link.b)) pin_links_.push_back(link);
        }
        for (const Spring& spring : springs_) {
            if (at_pin(spring.a, spring.b)) pin_springs_.push_back(spring);
        }
    }

    struct Energy {
        double kept = 0, kinetic = 0, elastic = 0, weight = 0;  // J; the last: of gravity
    };
    Energy of(const Net::State& state) const {
        Energy e;
        double pull = 0, added = 0, weight_pull = 0;
        for (Index i = 0; i < net_.size(); ++i) {
            if (net_.is_pinned(i)) continue;
            e.kinetic += net_.mass(i) / 2 * state.v.col(i).squaredNorm();
            e.weight -= net_.mass(i) * net_.gravity().dot(state.x.col(i));
            weight_pull += net_.mass(i) * net_.gravity().dot(state.v.col(i));
        }
        for (const Spring& spring : springs_) {
            const Eigen::Vector3d dx = state.x.col(spring.b) - state.x.col(spring.a);
            const double stretch = dx.norm() - spring.length;
            e.elastic += spring.k / 2 * stretch * stretch;
            pull += spring.force(state).dot(state.v.col(spring.a) - state.v.col(spring.b));
        }
        for (const Link& link : links_)
            added += link.inertia / 2 * (state.v.col(link.b) - state.v.col(link.a)).squaredNorm();
        e.kept = e.kinetic + added + e.elastic + e.weight + h_ / 2 * (pull + weight_pull) -
                 h_ / 2 * drag_ * e.kinetic;
        return e;
    }
    /// The work of the pins in one step, J: h·½(v + v⁺)·F, F being what moves them,
    /// (M̃ − M)Δv/h + D_i(v + v⁺)/2 − f.
    /// @param v  before the step and before the pins were given their new velocity
    double pin_work(const Net::State& before, const taut::Points<double, 3>& v,
                    const Net::State& after) const {
        double work = 0;
        const auto add = [&](Index i, const Eigen::Vector3d& impulse) {
            if (net_.is_pinned(i)) work += impulse.dot(v.col(i) + after.v.col(i)) / 2;
        };
        for (const Link& link : pin_links_) {
            const Eigen::Vector3d then = v.col(link.b) - v.col(link.a);
            const Eigen::Vector3d now = after.v.col(link.b) - after.v.col(link.a);
            const Eigen::Vector3d change =
                link.inertia * (now - then) + link.braking / 2 * (now + then);
            add(link.a, -change);
            add(link.b, change);
        }
        for (const Spring& spring : pin_springs_) {
            const Eigen::Vector3d force = spring.force(before);
            add(spring.a, -h_ * force);
            add(spring.b, h_ * force);
        }
        return work;
    }

private:
    struct Link {
        Index a, b;
        double inertia;  // kg
        double braking;  // hD_i, kg
    };
    struct Spring {
        Index a, b;
        double k, length;

        /// On a.
        Eigen::Vector3d force(const Net::State& state) const {
            const Eigen::Vector3d dx = state.x.col(b) - state.x.col(a);
            const double l = dx.norm();
            return l > 0 ? Eigen::Vector3d(k * (1 - length / l) * dx) : Eigen::Vector3d::Zero();
        }
    };
    bool at_pin(Index a, Index b) const { return net_.is_pinned(a) || net_.is_pinned(b); }

    const Net& net_;
    double h_;
    double drag_;
    std::vector<Link> links_, pin_links_;
    std::vector<Spring> springs_, pin_springs_;
};

/// A scene that moves for long.
struct Motion {
    const char* kind;
    Net net;
    Net::State start;
    double multiple;             // of the any-pose limit of the explicit step
    double reach = 0, rate = 0;  // of waved pins: m, rad/s
};

inline Motion random_motion(Random& random) {
    static const char* const kinds[] = {"cloth, hung",   "cloth, dropped", "cloth, waved",
                                        "cloth, thrown", "net, hung",      "net, waved",
                                        "garment, hung", "garment, waved"};
    const int kind = static_cast<int>(random.uniform(0, 8));
    Motion motion;
    motion.kind = kinds[kind];
    const auto size = static_cast<Index>(random.uniform(6, 17));
    const double factor = random.power(0, 3);
    if (kind >= 6) {
        motion.net = garment(rough_tube(size + 4, size, random), random.power(2, 4));
    } else {
        taut::ClothOptions options{size, size};
        options.stretch = random.power(2, 4);
        options.bend = kind >= 4 ? 0 : options.stretch / 10;
        options.diagonals = kind < 4;
        motion.net = taut::hanging_cloth<double>(options);
        const Index row = static_cast<Index>(random.uniform(0, static_cast<double>(size)));
        const bool part = random.uniform(0, 1) < 0.5;
        const bool patch = random.uniform(0, 1) < 0.5;
        stiffen(motion.net, factor, [&](Index a, Index b) {
            const bool in = patch ? a / size < size / 2 && b / size < size / 2
                                  : a / size == row && b / size == row;
            return part && in;
        });
        if (kind == 1 || kind == 3) motion.net.unpin(size - 1);
        if (kind == 3) {
            motion.net.unpin(0);
            motion.net.set_gravity({0, 0, 0});
        }
    }
    if (random.uniform(0, 3) < 1) motion.net.set_rayleigh({random.uniform(0, 1), 0});
    motion.start = motion.net.initial_state();
    const double speed = kind == 3 ? random.power(-1, 1) : random.power(-3, 0);
    for (Index i = 0; i < motion.net.size(); ++i) {
        if (!motion.net.is_pinned(i)) motion.start.v.col(i) = speed * random.cube<3>();
    }
    motion.multiple = random.power(0.3, 1.3);
    if (kind == 2 || kind == 5 || kind == 7) {
        motion.reach = random.uniform(0.05, 0.5);
        motion.rate = random.uniform(2, 8);
    }
    return motion;
}

/// Velocities of waved pins.
inline void wave(const Motion& motion, double time, Net::State& state) {
    const double phase = motion.rate * time;
    for (Index i = 0; i < motion.net.size(); ++i) {
        if (!motion.net.is_pinned(i)) continue;
        state.v.col(i) =
            motion.reach * motion.rate * Eigen::Vector3d(0, std::cos(phase), std::sin(2 * phase));
    }
}

/// Above the start and the work of outside, as a share of kinetic + elastic + work.
struct Excess {
    double worst = 0;  // of all looks, 60 a second
    double late = 0;   // mean of the last second
    bool failed = false;
};

inline Excess watch(const Motion& motion, const taut::GraphInertiaOptions& options,
                    double seconds) {
    Net net = motion.net;
    const double h =
        frame / std::ceil(frame / (motion.multiple * taut::any_pose_limit(net).certified));
    const auto substeps = static_cast<Index>(std::lround(frame / h));
    taut::GraphInertia stepper(net, options);
    Excess excess;
    if (!stepper.prepare(h)) {
        excess.failed = true;
        return excess;
    }
    const Kept kept(net, stepper.shares(), h, options.dissipation);
    auto state = motion.start;
    if (motion.reach > 0) wave(motion, 0, state);  // a jump before the first step is no step's
    const auto start = kept.of(state);
    double work = 0;
    const int looks = static_cast<int>(std::lround(60 * seconds));
    for (int look = 0; look < looks && !excess.failed && excess.worst < 1; ++look) {
        auto before_pins = state.v;
        if (motion.reach > 0) {
            wave(motion, look * frame, state);
            for (Index step = 0; step < substeps && !excess.failed; ++step) {
                const auto before = state;
                excess.failed = !stepper.step(state, h);
                work += kept.pin_work(before, before_pins, state);
                before_pins = state.v;
            }
        } else {
            excess.failed = !stepper.step(state, h, substeps);
        }
        const auto now = kept.of(state);
        const double done = work + start.weight - now.weight;
        const double share =
            (now.kept - start.kept - work) / (now.kinetic + now.elastic + std::abs(done));
        excess.worst = std::max(excess.worst, share);
        if (look >= looks - 60) excess.late += share / 60;
    }
    return excess;
}

/// @returns of so many motions, by kind and together, those whose kept energy exceeds
inline void kept_row(int motions, double seconds, const taut::GraphInertiaOptions& options) {
    Random random(17);
    int failed = 0, above = 0, late = 0;
    double worst = 0, last = 0;
    const char* kind = "";
    for (int i = 0; i < motions; ++i) {
        Motion motion = random_motion(random);
        const Excess excess = watch(motion, options, seconds);
        failed += excess.failed;
        above += excess.worst > 0.01;
        late += excess.late > 0.01;
        if (excess.worst > worst) kind = motion.kind;
        worst = std::max(worst, excess.worst);
        last = std::max(last, excess.late);
    }
    std::printf("| %g | %g | %d | %d | %d | %d | %.3f, %s | %.3f |\n", options.margin,
                options.dissipation, motions, failed, above, late, 100 * worst, kind, 100 * last);
    std::fflush(stdout);
}

}  // namespace bench::graph_inertia
