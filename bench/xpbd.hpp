// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <taut/network/hookean.hpp>
#include <taut/network/state.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/step/register.hpp>
#include <type_traits>
#include <vector>

namespace bench {

/// XPBD with small steps (Macklin et al., "Small steps in physics simulation", SCA 2019): a
/// prediction from the last two positions, then one pass over the springs. Each moves its ends by
/// ∓w (l − L)/(w_a + w_b + 1/(k h²)) along itself; a TensionOnly spring only where it is too long.
/// Of damping the system's drag a mass alone; pins move as they are told.
template <class Scalar>
class XpbdOf {
public:
    using State = taut::State<Scalar, 3>;
    // A fourth coordinate, always 0, makes a particle one register.
    using Vector = Eigen::Matrix<Scalar, 4, 1>;

    enum class Order {
        given,    ///< of the net
        coloured  ///< springs of a colour share no particle: four of them are moved at once
    };

    /// @param h  s, of every step
    template <class System>
    XpbdOf(const System& system, Scalar h, Order order = Order::coloured)
        : h_(h), state_(system.initial_state()) {
        const auto w = system.inverse_mass();
        for (taut::Index i = 0; i < system.size(); ++i) {
            x_.push_back(Vector::Zero());
            x_.back().template head<3>() = state_.x.col(i);
            fall_.push_back(Vector::Zero());
            if (w[i] > 0) fall_.back().template head<3>() = h * h * system.gravity();
            const Scalar drag = w[i] > 0 ? Scalar(system.rayleigh().mass_proportional) : Scalar(0);
            keep_.push_back(1 / (1 + h * drag));
        }
        before_ = x_;
        system.for_each_set([&](const auto& set) { add_springs(set, w, order); });
    }

    void step(taut::Index count) {
        step(count, [](taut::Index) {});
    }
    /// @param respond  respond(i) after step i, which may change places()
    template <class Respond>
    void step(taut::Index count, Respond&& respond) {
        for (taut::Index i = 0; i < count; ++i) {
            predict();
            const Springs springs{a_.data(), b_.data(), rest_length_.data(), share_a_.data(),
                                  share_b_.data()};
            for (const Group& group : groups_) {
                group.pushes ? move_all<Four, true>(springs, x_.data(), group)
                             : move_all<Four, false>(springs, x_.data(), group);
            }
            respond(i);
        }
    }
    /// Gives a pin a velocity, m/s.
    void move_pin(taut::Index i, const Eigen::Matrix<Scalar, 3, 1>& v) {
        before_[i].template head<3>() = x_[i].template head<3>() - h_ * v;
    }
    const State& state() {
        for (taut::Index i = 0; i < state_.x.cols(); ++i) {
            state_.x.col(i) = x_[i].template head<3>();
            state_.v.col(i) = (x_[i] - before_[i]).template head<3>() / h_;
        }
        return state_;
    }
    /// m, at the end of the last step and at its start.
    std::vector<Vector>& places() { return x_; }
    const std::vector<Vector>& places_before() const { return before_; }

private:
    // Taut's own, with its 1/√: division and root would be most of a pass.
    static constexpr std::size_t lanes = 4;
    using Four = taut::step_detail::VectorRegister<Scalar, int(lanes)>;

    struct Group {
        std::size_t first;
        std::size_t first_single;  // four at a time up to here
        std::size_t end;
        bool pushes;
    };

    template <class Law, class Weights>
    void add_springs(const taut::SpringSet<Scalar, Law>& springs, const Weights& w, Order order);
    template <class Set>
    static std::vector<int> colours_of(const Set& springs, taut::Index particles);

    /// x ← x + h v + h² g with h v = x − (x one step before).
    void predict() {
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const Vector x = x_[i];
            x_[i] = (x + fall_[i]) + keep_[i] * (x - before_[i]);
            before_[i] = x;
        }
    }
    // By value in every pass: the members themselves would be read anew after every store.
    struct Springs {
        const int *a, *b;
        const Scalar *rest_length, *share_a, *share_b;
    };
    template <bool pushes>
    static EIGEN_ALWAYS_INLINE void move(const Springs springs, Vector* x, std::size_t s) {
        Vector& a = x[springs.a[s]];
        Vector& b = x[springs.b[s]];
        const Vector d = b - a;
        Scalar change = 1 - springs.rest_length[s] / std::sqrt(d.squaredNorm() + tiny);
        if constexpr (!pushes) change = std::max(change, Scalar(0));
        a += change * springs.share_a[s] * d;
        b -= change * springs.share_b[s] * d;
    }
    template <class Register, bool pushes>
    static void move_four(const Springs springs, Vector* x, std::size_t s);
    // A template: where registers are narrower, all springs are moved one by one. Not inlined: the
    // compiler finds enough registers then.
    template <class Register, bool pushes>
    static EIGEN_DONT_INLINE void move_all(const Springs springs, Vector* x, const Group group) {
        std::size_t s = group.first;
        if constexpr (Register::width == lanes) {
            for (; s < group.first_single; s += lanes) move_four<Register, pushes>(springs, x, s);
        }
        for (; s < group.end; ++s) move<pushes>(springs, x, s);
    }

    // Keeps 0/0 away where the ends of a spring meet.
    static constexpr Scalar tiny = std::numeric_limits<Scalar>::min();

    Scalar h_;
    State state_;
    std::vector<Vector> x_, before_, fall_;  // m; fall: h² g, 0 for pins
    std::vector<Scalar> keep_;               // of its velocity a step
    std::vector<int> a_, b_;
    std::vector<Scalar> rest_length_;        // m
    std::vector<Scalar> share_a_, share_b_;  // of l − L that each end goes
    std::vector<Group> groups_;
};

using Xpbd = XpbdOf<double>;

template <class Scalar>
template <class Register, bool pushes>
EIGEN_ALWAYS_INLINE void XpbdOf<Scalar>::move_four(const Springs springs, Vector* x,
                                                   std::size_t s) {
    using taut::step_detail::transpose;
    Register a[lanes], b[lanes], d[lanes], row[lanes];
    for (std::size_t i = 0; i < lanes; ++i) {
        a[i] = Register::load(x[springs.a[s + i]].data());
        b[i] = Register::load(x[springs.b[s + i]].data());
        row[i] = d[i] = b[i] - a[i];
    }
    transpose(row[0].packet, row[1].packet, row[2].packet, row[3].packet);
    const Register squares = row[0] * row[0] + row[1] * row[1] + row[2] * row[2] + Register(tiny);
    Register change =
        Register(1) - Register::load(springs.rest_length + s) * reciprocal_sqrt(squares);
    if constexpr (!pushes) change = larger(change, Register(0));
    alignas(32) Scalar by_a[lanes], by_b[lanes];
    (change * Register::load(springs.share_a + s)).store(by_a);
    (change * Register::load(springs.share_b + s)).store(by_b);
    for (std::size_t i = 0; i < lanes; ++i) {
        (a[i] + Register(by_a[i]) * d[i]).store(x[springs.a[s + i]].data());
        (b[i] - Register(by_b[i]) * d[i]).store(x[springs.b[s + i]].data());
    }
}

/// Of every spring, from 0: the least that no spring before it has at the same particle.
template <class Scalar>
template <class Set>
std::vector<int> XpbdOf<Scalar>::colours_of(const Set& springs, taut::Index particles) {
    std::vector<std::vector<bool>> taken(particles);
    const auto is_taken = [&](taut::Index i, std::size_t colour) {
        return colour < taken[i].size() && taken[i][colour];
    };
    std::vector<int> colours;
    for (std::size_t s = 0; s < springs.a.size(); ++s) {
        std::size_t colour = 0;
        while (is_taken(springs.a[s], colour) || is_taken(springs.b[s], colour)) ++colour;
        for (const taut::Index end : {springs.a[s], springs.b[s]}) {
            taken[end].resize(std::max(taken[end].size(), colour + 1));
            taken[end][colour] = true;
        }
        colours.push_back(static_cast<int>(colour));
    }
    return colours;
}

template <class Scalar>
template <class Law, class Weights>
void XpbdOf<Scalar>::add_springs(const taut::SpringSet<Scalar, Law>& springs, const Weights& w,
                                 Order order) {
    constexpr bool pushes = std::is_same_v<Law, taut::Hookean>;
    static_assert(pushes || std::is_same_v<Law, taut::TensionOnly>);
    std::vector<std::size_t> sorted(springs.a.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t(0));
    const std::size_t start = a_.size();
    if (order == Order::given) {
        groups_.push_back({start, start, start + sorted.size(), pushes});
    } else {
        const auto colours = colours_of(springs, w.size());
        std::stable_sort(sorted.begin(), sorted.end(),
                         [&](std::size_t s, std::size_t t) { return colours[s] < colours[t]; });
        for (std::size_t first = 0, end = 0; first < sorted.size(); first = end) {
            while (end < sorted.size() && colours[sorted[end]] == colours[sorted[first]]) ++end;
            groups_.push_back(
                {start + first, start + end - (end - first) % lanes, start + end, pushes});
        }
    }
    for (const std::size_t s : sorted) {
        const Scalar w_a = w[springs.a[s]];
        const Scalar w_b = w[springs.b[s]];
        const Scalar compliance = 1 / (springs.parameters[s].stiffness * h_ * h_);
        a_.push_back(static_cast<int>(springs.a[s]));
        b_.push_back(static_cast<int>(springs.b[s]));
        rest_length_.push_back(springs.rest_length[s]);
        share_a_.push_back(w_a / (w_a + w_b + compliance));
        share_b_.push_back(w_b / (w_a + w_b + compliance));
    }
}

}  // namespace bench
