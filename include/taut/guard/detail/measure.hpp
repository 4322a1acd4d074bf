// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "parts.hpp"

namespace taut::guard_detail {

/// Fills Part::now of every part, in a pass over particles and one over springs. Sums are in
/// double, of numbers in the system's own.
template <class System>
class Measure {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    /// @param h  of a step, s   @param force  outside forces at the state, N; may be empty
    void operator()(const System& system, const State& state, Scalar h,
                    const typename System::Force& force, Parts<System>& parts) {
        reach_ = state.x.colwise().norm();
        const auto weight = static_cast<double>(system.gravity().norm());
        for (auto& part : parts) part.now = {};
        for (Index i = 0; i < system.size(); ++i) {
            const int which = parts.of(i);
            if (which < 0) {  // what its springs make of rounding at a pin that moves
                reach_[i] += reach_[i] + h * state.v.col(i).norm();
                continue;
            }
            auto& now = parts[which].now;
            const auto mass = static_cast<double>(system.mass(i));
            const Vector v = state.v.col(i).template cast<double>();
            const Vector x = state.x.col(i).template cast<double>();
            now.owned += mass * v.squaredNorm();
            now.momentum += mass * v;
            now.moment += mass * x;
            now.mass += mass;
            double load = mass * weight;
            if (force.cols() > 0) load += static_cast<double>(force.col(i).norm());
            now.scale += load * static_cast<double>(reach_[i]);
        }
        for (auto& part : parts) {
            auto& now = part.now;
            now.scale += now.owned;
            now.owned /= 2;
            const double along = now.momentum.squaredNorm() / (2 * now.mass);
            now.kinetic = std::max(0.0, now.owned - along);
        }
        system.for_each_set([&](const auto& set) { add(set, state, h, parts); });
    }

private:
    using Vector = Eigen::Matrix<double, System::Dim, 1>;
    static constexpr Index chunk = 64;
    using Numbers = Eigen::Array<Scalar, chunk, 1>;

    /// What a register can hold is computed for a chunk at a time.
    template <class Set>
    void add(const Set& set, const State& state, Scalar h, Parts<System>& parts) {
        const Index size = set.size();
        Numbers l = Numbers::Zero(), w = l, reach = l, energy = l, scale = l;
        for (Index first = 0; first < size; first += chunk) {
            const Index count = std::min(chunk, size - first);
            for (Index j = 0; j < count; ++j) {
                const int a = set.a[first + j], b = set.b[first + j];
                l[j] = (state.x.col(b) - state.x.col(a)).squaredNorm();
                w[j] = (state.v.col(b) - state.v.col(a)).squaredNorm();
                reach[j] = reach_[a] + reach_[b];
            }
            l = l.max(std::numeric_limits<Scalar>::min()).sqrt();
            w = w.sqrt() * h;
            for (Index j = 0; j < count; ++j) {
                const auto spring = set[first + j];
                energy[j] = spring.energy(l[j]);
                scale[j] = std::abs(spring.tension(l[j])) + spring.stiffness_bound() * w[j];
            }
            scale *= reach + l;
            if (parts.one()) {
                parts[0].now.owned += energy.head(count).template cast<double>().sum();
                parts[0].now.scale += scale.head(count).template cast<double>().sum();
                continue;
            }
            for (Index j = 0; j < count; ++j) {
                const int part = parts.of(set.a[first + j], set.b[first + j]);
                if (part < 0) continue;
                parts[part].now.owned += static_cast<double>(energy[j]);
                parts[part].now.scale += static_cast<double>(scale[j]);
            }
        }
    }

    Eigen::Matrix<Scalar, 1, Eigen::Dynamic> reach_;  // |x|, of pins 2|x| + h|u|, m
};

}  // namespace taut::guard_detail
