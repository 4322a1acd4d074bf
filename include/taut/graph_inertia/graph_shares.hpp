// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../core/status.hpp"
#include "../model/spring_system.hpp"
#include "../stability/detail/symplectic_limit.hpp"
#include "../stability/spring_pencil.hpp"

namespace taut {

/// How far each spring of a scene is implicit, and the step that this was made for [T33].
struct GraphShares {
    Status status = Status::ok;  ///< not ok: no shares make that step safe
    double step = 0;             ///< h₀, s
    double margin = 1;           ///< θ
    std::vector<double> shares;  ///< s of each spring, in index order, 0 … 1
    std::uint64_t revision = 0;  ///< of the system

    /// s = 1 for every spring: safe at every h with h·d0 < 2θ.
    void make_all_implicit() { std::fill(shares.begin(), shares.end(), 1.0); }
    /// Springs with a share.
    Index implicit_springs() const {
        return std::count_if(shares.begin(), shares.end(), [](double s) { return s > 0; });
    }
};

/// visit(a, b, damped, elastic) for each spring with a share: its ends, and the two parts of what
/// it adds to M̃ = M + Σ (damped + elastic)L_e: s·½hc/θ and s·¼h²k/θ, kg [T33].
template <class System, class Visitor>
void for_each_inertia(const System& system, const GraphShares& shares, Visitor&& visit) {
    const double h = shares.step;
    const double alpha = system.stiffness_damping().total();
    std::size_t index = 0;
    system.visit_springs([&](const auto& its) {
        const double share = shares.shares[index++] / shares.margin;
        if (!(share > 0)) return;
        const auto spring = its.template cast<double>();
        const double k = spring.stiffness_bound();
        visit(its.a, its.b, share * h * (spring.damping + alpha * k) / 2, share * h * h * k / 4);
    });
}

/// Free particles that springs with a share end at.
template <class System>
Index touched_particles(const System& system, const GraphShares& shares) {
    std::vector<char> touched(static_cast<std::size_t>(system.size()), 0);
    for_each_inertia(system, shares, [&](Index a, Index b, double, double) {
        for (const Index i : {a, b}) touched[static_cast<std::size_t>(i)] = !system.is_pinned(i);
    });
    return std::count(touched.begin(), touched.end(), 1);
}

namespace stability_detail {

/// Fails by the function's name unless the shares are of the system as it is.
template <class System>
void require_shares_of(const char* function, const System& system, const GraphShares& shares) {
    if (shares.revision != system.revision() ||
        static_cast<Index>(shares.shares.size()) != system.spring_count())
        fail(function, ": the shares are of another revision of the system");
}

/// Appends weight·L_e of a spring between two rows; a negative one is a pin's and has no entries.
inline void add_laplacian(int a, int b, double weight,
                          std::vector<Eigen::Triplet<double>>& entries) {
    for (const int row : {a, b}) {
        if (row >= 0) entries.emplace_back(row, row, weight);
    }
    if (a < 0 || b < 0) return;
    entries.emplace_back(a, b, -weight);
    entries.emplace_back(b, a, -weight);
}

/// The springs of 2hD + h²L_k between free particles, and the shares that fit them to what the
/// masses bear.
class ShareSearch {
public:
    /// @param allowed  (4θ − 2h d0)m of each free particle, kg
    ShareSearch(const SpringPencil<1>& pencil, double h, std::vector<double> allowed)
        : allowed_(std::move(allowed)) {
        pencil.for_each_link(2 * h * D + h * h * K_plus,
                             [&](int a, int b, const auto&, double axial, double) {
                                 springs_.push_back({a, b, axial, 1, 0});
                             });
        weight_.reserve(allowed_.size());
        for (Index i = 0; i < pencil.size(); ++i)
            weight_.push_back(1 / std::sqrt(pencil.mass()[i]));
        load_.resize(allowed_.size());
        heaviest_.resize(allowed_.size());
    }

    /// Lowers explicit parts until every particle bears its load [T33].
    void run() {
        double largest = measure();
        if (largest < 2) {
            const std::vector<double> even = weight_;
            for (int repeat = 0; repeat < 60 && largest > bound; ++repeat) {
                improve_weights(largest);
                largest = measure();
            }
            if (largest <= bound) return;
            weight_ = even;  // the others lean on the stiffest
            largest = measure();
        }
        for (int repeat = 0; repeat < 300 && largest > 1 + 1e-3; ++repeat) {
            shrink();
            lean();
            largest = measure();
        }
        if (largest > bound) settle();
    }
    /// 1 − s of the springs, in the pencil's order.
    double explicit_part(std::size_t s) const { return springs_[s].part; }
    std::size_t size() const { return springs_.size(); }

private:
    struct Link {
        int a, b;     // free particle, or −1 when pinned
        double pull;  // 2hc + h²k, kg
        double part;  // 1 − s
        double less;  // of shrink(): −ln of the factor on it
    };
    /// What rounding may add to a load.
    static constexpr double bound = 1 - 1e-9;

    double load_at(const Link& link, int i, int other) const {
        return link.part * link.pull * (other < 0 ? 1 : 1 + weight_[other] / weight_[i]) /
               allowed_[i];
    }
    template <class Visitor>
    void for_each_end(Visitor&& visit) {
        for (Link& link : springs_) {
            if (link.a >= 0) visit(link, link.a, link.b);
            if (link.b >= 0) visit(link, link.b, link.a);
        }
    }
    /// The loads of [T26] as shares of what each particle bears. @returns the largest
    double measure() {
        std::fill(load_.begin(), load_.end(), 0);
        std::fill(heaviest_.begin(), heaviest_.end(), 0);
        for_each_end([&](const Link& link, int i, int other) {
            const double load = load_at(link, i, other);
            load_[i] += load;
            heaviest_[i] = std::max(heaviest_[i], load);
        });
        return load_.empty() ? 0 : *std::max_element(load_.begin(), load_.end());
    }
    /// As upper bounds of the whole scene do [T26].
    void improve_weights(double largest) {
        for (std::size_t i = 0; i < load_.size(); ++i) {
            weight_[i] *= std::sqrt(std::max(load_[i] / largest, 1e-4));
        }
    }
    /// Who bears too much leans on neighbours that bear less.
    void lean() {
        for (std::size_t i = 0; i < load_.size(); ++i) {
            weight_[i] *= std::pow(std::clamp(load_[i], 1.0, 1.2), 0.1);
        }
    }
    /// A spring gives way as it takes part in what is too much: soft neighbours of a stiff one stay
    /// explicit.
    void shrink() {
        for_each_end([&](Link& link, int i, int other) {
            if (!(load_[i] > 1)) return;
            link.less = std::max(link.less,
                                 0.3 * load_at(link, i, other) / heaviest_[i] * std::log(load_[i]));
        });
        for (Link& link : springs_) link.part *= std::exp(-std::exchange(link.less, 0));
    }
    /// At fixed weights loads are linear in the parts.
    void settle() {
        const auto over = [&](int i) { return i < 0 ? 0 : load_[i] / bound; };
        for (Link& link : springs_) {
            link.part /= std::max({1.0, over(link.a), over(link.b)});
        }
    }

    std::vector<double> allowed_;  // kg
    std::vector<Link> springs_;
    std::vector<double> weight_;    // p of [T26]
    std::vector<double> load_;      // of what is allowed
    std::vector<double> heaviest_;  // spring's part of it
};

}  // namespace stability_detail

/// Shares of implicitness that make step h certified at any pose [T33], and add little inertia: 0
/// for every spring where the explicit step is safe as it is. O(springs) for each of up to 360
/// passes.
///
/// not_positive_definite is the status where no shares will do: h·d0 ≥ 2θ, or numbers beyond the
/// range of double.
/// @param h  s, finite and > 0   @param margin  θ, in (0, 1]
template <class Scalar, int Dim, class... Laws>
GraphShares graph_shares(const SpringSystem<Scalar, Dim, Laws...>& system, double h,
                         double margin) {
    require_positive("graph_shares", "h", h);
    require_positive("graph_shares", "margin", margin);
    if (margin > 1) fail("graph_shares: margin is ", margin, "; it must be <= 1");
    GraphShares answer;
    answer.step = h;
    answer.margin = margin;
    answer.revision = system.revision();
    answer.shares.assign(static_cast<std::size_t>(system.spring_count()), 0);
    const auto pencil = SpringPencil<1>::any_pose(system);
    const double wide = h * (1 + stability_detail::step_rounding<Scalar>);
    const double left = 4 * margin - 2 * wide * pencil.rayleigh().mass_proportional;
    std::vector<double> allowed;
    for (Index i = 0; i < pencil.size(); ++i) allowed.push_back(left * pencil.mass()[i]);
    if (!pencil.lost().empty() || (pencil.size() > 0 && !(left > 0))) {
        answer.status = Status::not_positive_definite;
        return answer;
    }
    stability_detail::ShareSearch search(pencil, wide, std::move(allowed));
    search.run();
    std::size_t link = 0, spring = 0;
    system.for_each_spring([&](Index a, Index b) {
        if (!system.is_pinned(a) || !system.is_pinned(b)) {
            answer.shares[spring] = 1 - search.explicit_part(link++);
        }
        ++spring;
    });
    return answer;
}

}  // namespace taut
