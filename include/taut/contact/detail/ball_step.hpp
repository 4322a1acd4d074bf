// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ball_pairs.hpp"

namespace taut::contact_detail {

/// What touching balls came to at the end of a frame.
struct Overlap {
    Buffer<double> held;  // of each particle, J
    double energy = 0;    // its sum
    double work = 0;      // of pins that move, in the frame, J
    Index touching = 0;
    double deepest = 0;  // m
};

/// What pairs of balls do in one step, on the planes of a stepper.
template <class Scalar, int Dim>
class BallStep {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Access = PlaneAccess<Scalar, Dim>;

    /// Where a step began and what it came to without pairs.
    struct Where {
        const Buffer<int>& places;
        Access x, v;
        Scalar back;   // s: it began at x − back·v
        Access y;      // the springs' positions, one step ahead
        Scalar ahead;  // s; 0: pairs see where it began
    };

    Buffer<double> work;  ///< of pins that move on each particle in the frame, J

    void begin(Index count) {
        work.assign(count, 0);
        kick_.resize(Dim, count);
        is_hit_.assign(count, 0);
        hit_.clear();
    }
    /// Finds the kicks of all pairs that count. @param time  that the forces last, s
    void push(const BallPairs<Scalar, Dim>& list, const Where& at, Scalar time) {
        for (const int i : hit_) is_hit_[i] = 0;
        hit_.clear();
        pin_work_.clear();
        const Register tiny((std::numeric_limits<Scalar>::min)());
        detail::Few<Lanes, Dim> r, y;
        Lanes apart, deep, over;
        for (const auto* first = list.begin(); first < list.end(); first += Register::width) {
            const int count = (std::min)(int(list.end() - first), int(Register::width));
            for (int k = 0; k < count; ++k) {
                const int a = at.places[first[k].a], b = at.places[first[k].b];
                apart[k] = first[k].apart;
                for (int d = 0; d < Dim; ++d) {
                    r[d][k] = at.x(d, b) - at.x(d, a) - at.back * (at.v(d, b) - at.v(d, a));
                    y[d][k] = at.ahead > 0 ? at.y(d, b) - at.y(d, a) : r[d][k];
                }
            }
            for (int k = count; k < Register::width; ++k) {
                apart[k] = -1;
                for (int d = 0; d < Dim; ++d) r[d][k] = y[d][k] = 0;
            }
            Register r2(Scalar(0)), along(Scalar(0));
            for (int d = 0; d < Dim; ++d) {
                const Register from = Register::load(r[d].data());
                r2 += from * from;
                along += from * Register::load(y[d].data());
            }
            // n·y does not forget a pair that passes through, and |y| would.
            const Register by_length = Register(Scalar(1)) / sqrt(larger(r2, tiny));
            const Register held = Register::load(apart.data());
            const Register overlap = where_less(tiny, r2, held - along * by_length, held);
            if (!(largest_lane(overlap) > 0)) continue;
            overlap.store(deep.data());
            where_less(tiny, r2, by_length, Register(Scalar(0))).store(over.data());
            for (int k = 0; k < count; ++k) {
                if (!(deep[k] > 0)) continue;
                Vector n;
                for (int d = 0; d < Dim; ++d) n[d] = over[k] * r[d][k];
                if (!(over[k] > 0)) {  // any will do
                    n = Vector::Unit(0);
                    deep[k] = apart[k] - y[0][k];
                }
                push(first[k], list, at, time * first[k].stiffness * deep[k] * n);
            }
        }
    }
    /// The largest change of a velocity, m/s.
    Scalar largest_kick() const {
        Scalar most = 0;
        for (const int i : hit_) most = (std::max)(most, kick_.col(i).squaredNorm());
        return std::sqrt(most);
    }
    /// Does what was found. @param spring_x  where springs will see them
    /// @param h  s, for which kicked particles have moved so; may be 0
    void apply(const Where& at, const Access& spring_x, Scalar h) {
        for (const int i : hit_) {
            const int place = at.places[i];
            for (int d = 0; d < Dim; ++d) {
                const Scalar v = at.v(d, place) += kick_(d, i);
                const Scalar x = at.x(d, place) += h * kick_(d, i);
                if (at.ahead > 0) spring_x(d, place) = x + at.ahead * v;
            }
        }
        for (const auto& [i, done] : pin_work_) work[i] += done;
    }
    /// The pairs' energy, half of it for either particle; all for one beside a pin.
    /// @param x  x(i), m
    template <class Positions>
    static void measure(const BallPairs<Scalar, Dim>& list, const Positions& x, Overlap& overlap) {
        overlap.held.assign(list.radius.size(), 0);
        overlap.energy = overlap.deepest = 0;
        overlap.touching = 0;
        for (const auto& pair : list) {
            const auto deep =
                static_cast<double>(pair.apart - Vector(x(pair.b) - x(pair.a)).norm());
            if (!(deep > 0)) continue;
            ++overlap.touching;
            overlap.deepest = (std::max)(overlap.deepest, deep);
            const double held = static_cast<double>(pair.stiffness) * deep * deep / 2;
            overlap.energy += held;
            overlap.held[list.inverse_mass[pair.a] > 0 ? pair.a : pair.b] += held / 2;
            overlap.held[list.inverse_mass[pair.b] > 0 ? pair.b : pair.a] += held / 2;
        }
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    using Lanes = detail::Few<Scalar, Register::width>;
    struct PinWork {
        int at;
        double work;  // J
    };

    /// @param impulse  on b, N s
    void push(const BallPair<Scalar>& pair, const BallPairs<Scalar, Dim>& list, const Where& at,
              const Vector& impulse) {
        for (const auto& [i, other, sign] : {Side{pair.a, pair.b, -1}, Side{pair.b, pair.a, 1}}) {
            const Scalar w = list.inverse_mass[i];
            if (!(w > 0)) {  // it is pushed, and pushes the other by as much
                const Scalar done = -sign * impulse.dot(at.v.vector(at.places[i]));
                if (done != 0) pin_work_.push_back({other, static_cast<double>(done)});
                continue;
            }
            if (!std::exchange(is_hit_[i], 1)) {
                hit_.push_back(i);
                kick_.col(i).setZero();
            }
            kick_.col(i) += sign * w * impulse;
        }
    }
    struct Side {
        int i, other;
        Scalar sign;
    };

    Points<Scalar, Dim> kick_;  // of particles in hit_, m/s
    Buffer<int> hit_, is_hit_;  // particles that have one; of each, whether
    Buffer<PinWork> pin_work_;  // of the step
};

}  // namespace taut::contact_detail
