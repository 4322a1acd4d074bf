// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/model/spring_system.hpp>
#include <vector>

#include "random.hpp"

namespace taut_test {

/// Energies by part, by an own reading of [T43] in long double.
struct PartEnergy {
    double energy = 0;   // E, J
    double kinetic = 0;  // K, J
    double grain = 0;    // what rounding makes of measuring E, J
};

/// Free particles joined by springs have one number, that of the first; pinned ones −1.
template <class System>
std::vector<Index> parts_of(const System& system) {
    std::vector<Index> of(static_cast<std::size_t>(system.size()));
    for (Index i = 0; i < system.size(); ++i) of[i] = system.is_pinned(i) ? -1 : i;
    for (bool changed = true; changed;) {
        changed = false;
        system.for_each_spring([&](Index a, Index b) {
            if (of[a] < 0 || of[b] < 0 || of[a] == of[b]) return;
            of[a] = of[b] = std::min(of[a], of[b]);
            changed = true;
        });
    }
    return of;
}

template <class System, class State>
std::vector<PartEnergy> part_energies(const System& system, const State& state) {
    using Real = long double;
    using Vector = Eigen::Matrix<Real, System::Dim, 1>;
    using Scalar = typename System::Scalar;
    const auto of = parts_of(system);
    const auto n = static_cast<std::size_t>(system.size());
    std::vector<Real> energy(n, 0), kinetic(n, 0), mass(n, 0), grain(n, 0);
    std::vector<Vector> momentum(n, Vector::Zero());
    const Vector g = system.gravity().template cast<Real>();
    for (Index i = 0; i < system.size(); ++i) {
        if (of[i] < 0) continue;
        const auto m = static_cast<Real>(system.mass(i));
        const Vector v = state.v.col(i).template cast<Real>();
        const Vector x = state.x.col(i).template cast<Real>();
        kinetic[of[i]] += m * v.squaredNorm() / 2;
        momentum[of[i]] += m * v;
        mass[of[i]] += m;
        energy[of[i]] -= m * g.dot(x);
        grain[of[i]] += std::numeric_limits<Real>::epsilon() * m * g.norm() * x.norm() * 4096;
    }
    system.visit_springs([&](const auto& own) {
        const Index part = of[own.a] >= 0 ? of[own.a] : of[own.b];
        if (part < 0) return;
        const auto spring = own.template cast<Real>();
        const Vector dx =
            (state.x.col(own.b).template cast<Real>() - state.x.col(own.a).template cast<Real>());
        const Real l =
            std::max(dx.norm(), std::sqrt(static_cast<Real>(std::numeric_limits<Scalar>::min())));
        energy[part] += spring.energy(l);
        const auto u = static_cast<Real>(std::numeric_limits<Scalar>::epsilon());
        const Real off = u * (l + spring.rest_length);
        grain[part] += std::abs(spring.tension(l)) * off + u * spring.energy(l) +
                       spring.stiffness_bound() * off * off;
    });
    std::vector<PartEnergy> result(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (mass[i] == 0) continue;
        const Real K = kinetic[i] - momentum[i].squaredNorm() / (2 * mass[i]);
        const Real u = static_cast<Real>(std::numeric_limits<Scalar>::epsilon());
        result[i] = {static_cast<double>(energy[i] + kinetic[i]),
                     static_cast<double>(std::max<Real>(K, 0)),
                     static_cast<double>(4 * grain[i] + u * kinetic[i])};
    }
    return result;
}

/// Checks E_n ≤ E_m + 0.1 K_m + Σ(W − Q + ρ + what edits added) for every m < n: for each part
/// while parts stay what they are, for a new part from the end of its first frame on, for it has a
/// share of the credit of the parts before; and for the sum always.
template <class System>
class Audit {
public:
    using State = typename System::State;

    Audit(const System& system, const State& state) : system_(&system) { open(state); }

    /// Somebody has changed system or state: what edits add.
    void edited(const State& state) {
        const auto now = part_energies(*system_, state);
        const bool same = parts_of(*system_) == of_;
        const PartEnergy sum = total(now);
        all_.bound += sum.energy - all_.last.energy;
        all_.last = sum;
        all_.grain = std::max(all_.grain, sum.grain);
        for (std::size_t i = 0; i < now.size() && same; ++i) {
            each_[i].bound += now[i].energy - each_[i].last.energy;
            each_[i].last = now[i];
        }
        if (same) return;
        of_ = parts_of(*system_);
        each_.assign(now.size(), {});
        for (auto& bound : each_) bound.bound = std::numeric_limits<double>::infinity();
    }
    /// After a frame that stands. @returns J, by how much the worst part broke the promise, in
    /// shares of its K and of what rounding does; ≤ 0 for kept
    template <class Guard, class Report>
    double frame(const State& state, const Guard& guard, const Report& report) {
        const auto now = part_energies(*system_, state);
        double worst = -1;
        for (const auto& part : guard.parts()) {
            const auto i = static_cast<std::size_t>(part.particle);
            worst = std::max(worst, step(each_[i], now[i], part));
        }
        return std::max(worst, step(all_, total(now), report));
    }

private:
    struct Bound {
        double bound = 0;  // the least of E_m + 0.1 K_m + Σ…, J
        PartEnergy last;
        double grain = 0;
        double most = 0;  // K so far
    };
    static Bound begun(const PartEnergy& at) {
        return {at.energy + 0.1 * at.kinetic, at, at.grain, at.kinetic};
    }
    static PartEnergy total(const std::vector<PartEnergy>& parts) {
        PartEnergy sum;
        for (const auto& part : parts) {
            sum.energy += part.energy;
            sum.kinetic += part.kinetic;
            sum.grain += part.grain;
        }
        return sum;
    }
    template <class Books>
    static double step(Bound& bound, const PartEnergy& now, const Books& books) {
        bound.bound += books.work - books.loss + books.rounding;
        bound.grain = std::max(bound.grain, now.grain);
        bound.most = std::max(bound.most, now.kinetic);
        const double slack = 1e-10 * bound.most + 4 * bound.grain +
                             1e-12 * (std::abs(now.energy) + std::abs(books.work));
        const double over = now.energy - bound.bound - slack;
        bound.bound = std::min(bound.bound, now.energy + 0.1 * now.kinetic);
        bound.last = now;
        return over / (bound.most + slack + 1e-300);
    }
    void open(const State& state) {
        const auto now = part_energies(*system_, state);
        of_ = parts_of(*system_);
        for (const auto& part : now) each_.push_back(begun(part));
        all_ = begun(total(now));
    }

    const System* system_;
    std::vector<Index> of_;
    std::vector<Bound> each_;
    Bound all_;
};

}  // namespace taut_test
