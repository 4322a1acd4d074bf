// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/graph_inertia/graph_inertia_limit.hpp>

#include "scenes.hpp"

namespace bench::graph_inertia {

/// Springs of no rest length in one dimension, where the step is linear: masses over two decades,
/// stiffness over four, dampers on half of the springs of every second scene, drag in every third.
/// With isotropic springs and no dampers every coordinate in 2-D and 3-D moves like this one.
using Line = taut::SpringSystem<double, 1>;

inline Line random_line(Random& random, int scene) {
    Line line;
    const auto particles = static_cast<Index>(random.uniform(2, 11));
    for (Index i = 0; i < particles; ++i) {
        line.add_particle(random.cube<1>(), random.power(-1, 1));
    }
    const auto springs = static_cast<Index>(random.uniform(1, 3)) * particles;
    for (Index s = 0; s < springs; ++s) {
        const auto n = static_cast<double>(particles);
        const auto a = static_cast<Index>(random.uniform(0, n));
        const auto b = (a + 1 + static_cast<Index>(random.uniform(0, n - 1))) % particles;
        const double k = random.power(0, 4);
        const bool damped = scene % 2 == 1 && random.uniform(0, 1) < 0.5;
        const double c = damped ? random.power(-2, 1) : 0;
        line.add_spring(taut::Spring<double, taut::Hookean>{a, b, {k}, 0, c});
    }
    if (random.uniform(0, 1) < 0.5) line.pin(0);
    if (scene % 3 == 2) line.set_rayleigh({random.power(-2, 0), 0});
    return line;
}

/// (x, v) → (x⁺, v⁺) of the free particles, written from [T33] with nothing of the library's in it
/// but the shares: M̃(v⁺ − v) = −h(Kx + Dv), x⁺ = x + hv⁺.
inline Eigen::MatrixXd step_matrix(const Line& line, const taut::GraphShares& shares, double h) {
    std::vector<Index> place(static_cast<std::size_t>(line.size()), -1);
    Index n = 0;
    for (Index i = 0; i < line.size(); ++i) {
        if (!line.is_pinned(i)) place[static_cast<std::size_t>(i)] = n++;
    }
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), K = M, D = M, more = M;
    for (Index i = 0; i < line.size(); ++i) {
        const Index j = place[static_cast<std::size_t>(i)];
        if (j >= 0) M(j, j) = line.mass(i);
    }
    D = line.rayleigh().mass_proportional * M;
    std::size_t s = 0;
    line.visit_springs([&](const auto& spring) {
        const Index a = place[static_cast<std::size_t>(spring.a)];
        const Index b = place[static_cast<std::size_t>(spring.b)];
        Eigen::VectorXd ends = Eigen::VectorXd::Zero(n);
        if (a >= 0) ends[a] += 1;
        if (b >= 0) ends[b] -= 1;
        const Eigen::MatrixXd L = ends * ends.transpose();
        const double k = spring.parameters.stiffness, c = spring.damping;
        K += k * L;
        D += c * L;
        more += shares.shares[s++] * (h * c / 2 + h * h * k / 4) / shares.margin * L;
    });
    const Eigen::LLT<Eigen::MatrixXd> heavier(M + more);
    Eigen::MatrixXd step(2 * n, 2 * n);
    step.bottomLeftCorner(n, n) = -h * heavier.solve(K);
    step.bottomRightCorner(n, n) = Eigen::MatrixXd::Identity(n, n) - h * heavier.solve(D);
    step.topRows(n) = h * step.bottomRows(n);
    step.topLeftCorner(n, n) += Eigen::MatrixXd::Identity(n, n);
    return step;
}

/// Largest velocity in the first and the second half of `count` steps from a random start; a run
/// that passes 1e100 ends there. Free motion as a whole is taken out at the start.
inline std::pair<double, double> peaks(const Eigen::MatrixXd& step, int count, Random& random) {
    const Index n = step.rows() / 2;
    Eigen::VectorXd state(2 * n), next(2 * n);
    for (Index i = 0; i < 2 * n; ++i) state[i] = i < n ? 0 : random.uniform(-1, 1);
    std::pair<double, double> most{0, 0};
    for (int i = 0; i < count; ++i) {
        next.noalias() = step * state;
        state.swap(next);
        double& half = i < count / 2 ? most.first : most.second;
        half = std::max(half, state.tail(n).cwiseAbs().maxCoeff());
        if (!(half < 1e100)) break;
    }
    return most;
}

/// Whether GraphInertia takes the step of that matrix, at the step of the shares.
inline double difference(const Line& line, const taut::GraphInertiaOptions& options, double h,
                         Random& random) {
    taut::GraphInertia stepper(line, options);
    auto state = line.initial_state();
    for (Index i = 0; i < line.size(); ++i) {
        if (!line.is_pinned(i)) state.v(0, i) = random.uniform(-1, 1);
        if (line.is_pinned(i)) state.x(0, i) = 0;
    }
    std::vector<double> free;
    for (Index i = 0; i < line.size(); ++i) {
        if (!line.is_pinned(i)) free.push_back(state.x(0, i));
    }
    for (Index i = 0; i < line.size(); ++i) {
        if (!line.is_pinned(i)) free.push_back(state.v(0, i));
    }
    if (!stepper.step(state, h)) return 1e300;
    const Eigen::VectorXd before = Eigen::Map<Eigen::VectorXd>(free.data(), free.size());
    const Eigen::VectorXd after = step_matrix(line, stepper.shares(), h) * before;
    Index j = after.size() / 2;
    double most = 0;
    for (Index i = 0; i < line.size(); ++i) {
        if (!line.is_pinned(i)) most = std::max(most, std::abs(state.v(0, i) - after[j++]));
    }
    return most / after.tail(after.size() / 2).cwiseAbs().maxCoeff();
}

inline bool stability_table(int scenes, int steps) {
    Random random(33);
    int bounded = 0, with_edge = 0, growing = 0;
    double gap = 0, furthest = 0, growth = 0;
    for (int scene = 0; scene < scenes; ++scene) {
        const Line line = random_line(random, scene);
        const taut::GraphInertiaOptions options;
        const double explicit_limit = taut::any_pose_limit(line).certified;
        const double drag = line.rayleigh().mass_proportional;
        double h = explicit_limit * random.power(0, 2);
        if (drag > 0) h = std::min(h, 0.9 * 2 * options.margin / drag);
        const auto shares = taut::graph_shares(line, h, options.margin);
        furthest = std::max(furthest, difference(line, options, h, random));
        const auto limit = taut::graph_inertia_limit(line, shares);
        const double below = 0.99 * std::min(limit.certified, 1e6 * h);
        const auto low = peaks(step_matrix(line, shares, below), steps, random);
        bounded += low.second <= 2 * low.first && low.second < 1e6;
        growth = std::max(growth, low.second / low.first);
        if (!(limit.refuted < 1e6 * h)) continue;
        ++with_edge;
        gap = std::max(gap, limit.refuted / limit.certified);
        const auto high = peaks(step_matrix(line, shares, 1.01 * limit.refuted), steps, random);
        growing += std::max(high.first, high.second) > 1e50;
    }
    std::printf(
        "## Bounded below what is certified, growing above what is refuted\n\n"
        "Shares made for 1 to 100 times the explicit limit, then fixed; the step's matrix from "
        "[T33].\n\n"
        "| scenes | steps | bounded at 0.99 of certified | largest velocity of the second half "
        "over that of the first, at most | with an edge | growing at 1.01 of refuted | refuted / "
        "certified, at most | the stepper beside that matrix |\n|---|---|---|---|---|---|---|---|\n"
        "| %d | %d | %d | %.2f | %d | %d | %.4f | %.1e |\n\n",
        scenes, steps, bounded, growth, with_edge, growing, gap, furthest);
    std::fflush(stdout);
    return bounded == scenes && growing == with_edge && furthest < 1e-6;
}

}  // namespace bench::graph_inertia
