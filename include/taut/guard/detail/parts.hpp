// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "../report.hpp"

namespace taut::guard_detail {

/// What a part has at a state.
template <int Dim>
struct Level {
    double owned = 0;    // kinetic and springs' energy, J
    double kinetic = 0;  // K, J
    double scale = 0;    // S of [T42], J
    double mass = 0;     // kg
    Eigen::Matrix<double, Dim, 1> moment = Eigen::Matrix<double, Dim, 1>::Zero();  // Σ m x, kg·m
    Eigen::Matrix<double, Dim, 1> momentum = Eigen::Matrix<double, Dim, 1>::Zero();  // kg·m/s

    bool finite() const { return std::isfinite(owned) && moment.allFinite(); }
};

/// A part, its books, and the frame that is being decided.
template <int Dim>
struct Part : GuardBooks {
    Level<Dim> start, now, end;
    double worked = 0;  // W so far, J
    double lost = 0;    // Q so far, J
    double step_lost = 0;
    int streak = 0;  // frames taken again, running
    int pause = 2;   // frames without a trial, when there are three
    int paused = 0;  // frames to go
};

/// The connected sets of free particles, with the credit of each [T43].
template <class System>
class Parts {
public:
    using Part = guard_detail::Part<System::Dim>;

    /// Where springs, pins or particles have come or gone: credits join, and are shared by free
    /// mass. @returns whether they have
    bool update(const System& system) {
        if (known_ && revision_ == system.topology_revision()) return false;
        known_ = true;
        revision_ = system.topology_revision();
        const auto old_of = std::exchange(of_, {});
        const auto old = std::exchange(list_, {});
        std::vector<double> mass(old.size(), 0);
        for (std::size_t i = 0; i < old_of.size(); ++i)
            if (old_of[i] >= 0) mass[old_of[i]] += static_cast<double>(system.mass(i));
        join(system);
        for (Index i = 0; i < system.size(); ++i) {
            if (of_[i] < 0 || i >= static_cast<Index>(old_of.size()) || old_of[i] < 0) continue;
            const double share = static_cast<double>(system.mass(i)) / mass[old_of[i]];
            list_[of_[i]].credit += share * old[old_of[i]].credit;
        }
        return true;
    }
    /// The part of a particle, −1 if it is pinned.
    int of(Index i) const { return of_[i]; }
    /// The part of a spring, −1 if both ends are pinned.
    int of(Index a, Index b) const { return of_[a] >= 0 ? of_[a] : of_[b]; }
    /// Whether that is the same for all springs.
    bool one() const { return one_; }
    /// The pinned particles.
    const std::vector<Index>& pins() const { return pins_; }
    auto begin() { return list_.begin(); }
    auto end() { return list_.end(); }
    Part& operator[](int part) { return list_[part]; }
    const std::vector<Part>& list() const { return list_; }

private:
    void join(const System& system) {
        of_.resize(system.size());
        std::iota(of_.begin(), of_.end(), 0);
        const auto root = [&](int i) {
            while (of_[i] != i) i = of_[i] = of_[of_[i]];
            return i;
        };
        pins_.clear();
        bool between_pins = false;
        system.for_each_spring([&](Index a, Index b) {
            const bool pins[] = {system.is_pinned(a), system.is_pinned(b)};
            between_pins = between_pins || (pins[0] && pins[1]);
            if (pins[0] || pins[1]) return;
            const int roots[] = {root(static_cast<int>(a)), root(static_cast<int>(b))};
            of_[std::max(roots[0], roots[1])] = std::min(roots[0], roots[1]);
        });
        for (int i = 0; i < static_cast<int>(of_.size()); ++i) {  // a root comes first
            if (system.is_pinned(i)) {
                of_[i] = -1;
                pins_.push_back(i);
            } else if (of_[i] == i) {
                of_[i] = static_cast<int>(list_.size());
                list_.emplace_back().particle = i;
            } else {
                of_[i] = of_[of_[i]];
            }
        }
        one_ = list_.size() == 1 && !between_pins;
    }

    std::vector<int> of_;
    std::vector<Index> pins_;
    std::vector<Part> list_;
    std::uint64_t revision_ = 0;
    bool known_ = false;
    bool one_ = false;
};

}  // namespace taut::guard_detail
