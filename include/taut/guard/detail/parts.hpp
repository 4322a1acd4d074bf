// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "../../core/types.hpp"
#include "../../network/spring_mechanics.hpp"

namespace taut::guard_detail {

/// What the guard knows of a part from frame to frame.
struct Part {
    /// d, J: what it has gained beyond its books, or else, < 0, what it may gain back.
    double balance = 0;
    int again = 0;      ///< frames in a row that were taken again
    int skip = 0;       ///< frames to come that are not tried
    int next_skip = 2;  ///< how many, the next time
    Index first = -1;   ///< its first particle
};

/// Free particles joined by springs; pins join nothing.
class Parts {
public:
    /// Follows the system's springs and pins. Where parts join, balances add; where one splits,
    /// the pieces share its balance by free mass [T43].
    /// @param touch  whether any two particles may push each other: then they are one part
    template <class System>
    void update(const System& system, bool touch) {
        if (of_.size() == static_cast<std::size_t>(system.size()) && touch_ == touch &&
            revision_ == system.topology_revision())
            return;
        revision_ = system.topology_revision();
        touch_ = touch;
        root_.resize(static_cast<std::size_t>(system.size()));
        std::iota(root_.begin(), root_.end(), Index(0));
        system.for_each_spring([&](Index a, Index b) {
            if (!system.is_pinned(a) && !system.is_pinned(b)) root_[at(root(a))] = root(b);
        });
        Index last = -1;
        for (Index i = 0; touch && i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            if (last >= 0) root_[at(root(last))] = root(i);
            last = i;
        }
        std::vector<Index> of(root_.size(), -1);
        std::vector<Part> list;
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            Index& part = of[at(root(i))];
            if (part < 0) {
                part = static_cast<Index>(list.size());
                list.emplace_back().first = i;
            }
            of[at(i)] = part;
        }
        std::vector<double> mass(list_.size(), 0);
        const auto each_old = [&](auto&& visit) {
            for (std::size_t i = 0; i < (std::min)(of.size(), of_.size()); ++i) {
                if (of[i] >= 0 && of_[i] >= 0)
                    visit(at(of[i]), at(of_[i]), static_cast<double>(system.mass(Index(i))));
            }
        };
        each_old([&](std::size_t, std::size_t from, double m) { mass[from] += m; });
        each_old([&](std::size_t to, std::size_t from, double m) {
            list[to].balance += list_[from].balance * m / mass[from];
        });
        of_ = std::move(of);
        list_ = std::move(list);
    }

    std::size_t count() const { return list_.size(); }
    /// The part of particle i, or −1 if it is pinned.
    Index of(Index i) const { return of_[at(i)]; }
    /// That of a spring: of either end, or −1 if both are pinned.
    Index of(Index a, Index b) const { return (std::max)(of(a), of(b)); }
    Part& operator[](std::size_t part) { return list_[part]; }
    const Part& operator[](std::size_t part) const { return list_[part]; }
    /// What is known of the parts now is what restore() puts back.
    void keep() { kept_ = list_; }
    void restore() { list_ = kept_; }
    /// Whether there are any, and none is to be tried.
    bool all_skip() const {
        return !list_.empty() && std::all_of(list_.begin(), list_.end(),
                                             [](const Part& part) { return part.skip > 0; });
    }

private:
    static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
    Index root(Index i) {
        while (root_[at(i)] != i) i = root_[at(i)] = root_[at(root_[at(i)])];
        return i;
    }

    std::vector<Index> of_;
    std::vector<Index> root_;  // workspace
    std::vector<Part> list_, kept_;
    std::uint64_t revision_ = 0;
    bool touch_ = false;
};

/// The energy of a part, of free particles and springs, with gravity.
struct Energy {
    double total = 0;    ///< E, J
    double kinetic = 0;  ///< K, about the centre of mass unless it hangs on a pin, J
    double speed = 0;    ///< Σ m|v|², J
    double mass = 0;     ///< kg
    double terms = 0;    ///< S, what rounding is a share of, J

    bool finite() const { return detail::is_finite(total + speed + terms); }
};

/// Measures every part in one pass over springs and one over particles; sums in double.
template <class System>
class EnergyMeter {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Vector = typename System::Vector;

    /// @param h  of the step whose rounding is asked for, s
    void measure(const System& system, const State& state, const Parts& parts, Scalar h,
                 std::vector<Energy>& energies) {
        energies.assign(parts.count(), {});
        sums_.assign(parts.count(), {});
        reach_.resize(system.size());
        add_particles(system, state, parts, h, energies);
        system.for_each_set([&](const auto& set) { add_springs(set, state, parts, h, energies); });
    }

private:
    struct Sums {
        double mass = 0;
        Eigen::Matrix<double, System::Dim, 1> momentum =
            Eigen::Matrix<double, System::Dim, 1>::Zero();
    };

    void add_particles(const System& system, const State& state, const Parts& parts, Scalar h,
                       std::vector<Energy>& energies) {
        const double weight = static_cast<double>(system.gravity().norm());
        const auto& constant = system.external_forces().constant;
        for (Index i = 0; i < system.size(); ++i) {
            const auto x = state.x.col(i);
            const auto v = state.v.col(i);
            // What is finite while its square is not cannot be told from an explosion.
            reach_[i] = std::sqrt(x.squaredNorm());
            const Index part = parts.of(i);
            if (part < 0) {
                reach_[i] += h * v.norm();
                continue;
            }
            auto& energy = energies[static_cast<std::size_t>(part)];
            auto& sums = sums_[static_cast<std::size_t>(part)];
            const auto mass = static_cast<double>(system.mass(i));
            const double speed = mass * static_cast<double>(v.squaredNorm());
            const double given =
                constant.cols() > i ? constant.col(i).template cast<double>().norm() : 0;
            energy.speed += speed;
            energy.total += speed / 2 - mass * static_cast<double>(system.gravity().dot(x));
            energy.terms += speed + (mass * weight + given) * static_cast<double>(reach_[i]);
            sums.mass += mass;
            sums.momentum += mass * v.template cast<double>();
        }
        for (std::size_t part = 0; part < energies.size(); ++part) {
            const double about = sums_[part].momentum.squaredNorm() / sums_[part].mass;
            energies[part].kinetic = (std::max)(0.0, (energies[part].speed - about) / 2);
            energies[part].mass = sums_[part].mass;
        }
    }
    template <class Set>
    void add_springs(const Set& set, const State& state, const Parts& parts, Scalar h,
                     std::vector<Energy>& energies) const {
        for (const auto spring : set) {
            const Index part = parts.of(spring.a, spring.b);
            if (part < 0) continue;
            const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
            const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
            const Scalar l = spring_length(dx);
            const Scalar pull = (std::abs)(spring.tension(l)) +
                                spring.stiffness_bound() * h * dv.template lpNorm<1>();
            const Scalar reach = reach_[spring.a] + reach_[spring.b] + spring.rest_length;
            auto& energy = energies[static_cast<std::size_t>(part)];
            const bool hangs = parts.of(spring.a) < 0 || parts.of(spring.b) < 0;
            if (hangs) energy.kinetic = energy.speed / 2;
            energy.total += static_cast<double>(spring.energy(l));
            energy.terms += static_cast<double>(pull) * static_cast<double>(reach);
        }
    }

    VectorX<Scalar> reach_;  // of each particle from the origin, m
    std::vector<Sums> sums_;
};

}  // namespace taut::guard_detail
