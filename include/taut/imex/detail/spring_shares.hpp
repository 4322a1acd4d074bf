// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "../../core/types.hpp"
#include "../../proof/step_limit.hpp"

namespace taut::imex_detail {

/// A spring of a scene: its ends, how far it is implicit, and what it adds to A if it is wholly so.
struct Link {
    Index a, b;      // particles
    double inertia;  // h²k + ½hc, kg
    double share;    // s, 0 … 1
};

/// The springs of a scene at a step h, and whether the masses bear what stays explicit.
class SpringShares {
public:
    /// @param h  s, finite and > 0
    template <class System>
    SpringShares(const System& system, double h) {
        // What steppers round must not end a proof.
        h *= 1 + proof_detail::step_rounding<typename System::Scalar>;
        drag_ = h * system.rayleigh().mass_proportional / 2;
        const double alpha = system.rayleigh().stiffness_proportional;
        system.visit_springs([&](const auto& its) {
            const auto spring = its.template cast<double>();
            const double k = spring.stiffness_bound();
            links_.push_back({its.a, its.b, h * h * k + h / 2 * (spring.damping + alpha * k), 0});
        });
        for (Index i = 0; i < system.size(); ++i)
            per_mass_.push_back(system.is_pinned(i) ? 0 : 1 / static_cast<double>(system.mass(i)));
    }

    /// All springs, in index order.
    const std::vector<Link>& links() const { return links_; }
    /// Sets the share of spring s.
    void set(std::size_t s, double share) { links_[s].share = share; }
    /// Makes springs implicit until the rest is proved, the stiffest beside their masses first:
    /// each one taken lightens the others. A pass is enough but for what rounding leaves of loads
    /// that are taken away.
    void choose() {
        std::vector<std::size_t> order(links_.size());
        std::iota(order.begin(), order.end(), std::size_t(0));
        const auto stiffness = [&](std::size_t s) {
            const Link& link = links_[s];
            return link.inertia * (per_mass_[at(link.a)] + per_mass_[at(link.b)]);
        };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t s, std::size_t t) { return stiffness(s) > stiffness(t); });
        while (!masses_bear()) {
            for (const std::size_t s : order) {
                if (bears(links_[s])) continue;
                add(links_[s], links_[s].share - 1);
                set(s, 1);
            }
        }
    }
    /// Whether (1 − ½h d0)M ⪰ Σ (1 − s)(h²k + ½hc)L_e, by Gershgorin, one column a spring: with B
    /// the differences and Q what is explicit, the non-zero eigenvalues of M⁻¹BᵀQB are those of
    /// QBM⁻¹Bᵀ.
    bool proved() { return masses_bear() && drag_ <= 1 - rounding; }

private:
    static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
    void add(const Link& link, double part) {
        for (const Index i : {link.a, link.b})
            load_[at(i)] += part * link.inertia * per_mass_[at(i)];
    }
    bool masses_bear() {
        load_.assign(per_mass_.size(), 0);
        for (const Link& link : links_) add(link, 1 - link.share);
        return std::all_of(links_.begin(), links_.end(),
                           [&](const Link& link) { return bears(link); });
    }
    bool bears(const Link& link) const {
        return link.share == 1 || load_[at(link.a)] + load_[at(link.b)] <= 1 - drag_ - rounding;
    }
    /// Of the sums, many times over.
    static constexpr double rounding = 1e-9;

    std::vector<Link> links_;
    std::vector<double> per_mass_;  // 1/kg, 0 of pins
    std::vector<double> load_;      // of each particle: Σ (1 − s)(h²k + ½hc)/m
    double drag_;                   // ½h d0
};

}  // namespace taut::imex_detail
