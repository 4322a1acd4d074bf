// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <functional>
#include <vector>

#include "outcome.hpp"

namespace bench {

using Vector = std::vector<double>;

/// M⁻¹f(x) of an undamped net by System::force, for libraries that know plain vectors.
class Acceleration {
public:
    explicit Acceleration(const Net& net) : net_(&net), given_(net.initial_state()) {}
    void operator()(const double* x, double* rate) {
        std::copy(x, x + given_.x.size(), given_.x.data());
        net_->force(given_, f_);
        for (taut::Index i = 0; i < net_->size(); ++i) f_.col(i) *= net_->inverse_mass()[i];
        std::copy(f_.data(), f_.data() + f_.size(), rate);
    }

private:
    const Net* net_;
    Net::State given_;
    taut::Points<double, 3> f_;
};

/// Boost.odeint's symplectic Euler: q' = p, p' = M⁻¹f(q).
class OdeintSymplectic {
public:
    explicit OdeintSymplectic(const Net& net)
        : acceleration_(net),
          state_(net.initial_state()),
          q_(state_.x.data(), state_.x.data() + state_.x.size()),
          p_(q_.size(), 0) {}
    void step(double h, taut::Index count) {
        const auto velocity = [](const Vector& p, Vector& rate) { rate = p; };
        const auto acceleration = [this](const Vector& q, Vector& rate) {
            acceleration_(q.data(), rate.data());
        };
        for (taut::Index i = 0; i < count; ++i) {
            stepper_.do_step(std::make_pair(velocity, acceleration),
                             std::make_pair(std::ref(q_), std::ref(p_)), 0, h);
        }
    }
    const Net::State& state() {
        std::copy(q_.begin(), q_.end(), state_.x.data());
        std::copy(p_.begin(), p_.end(), state_.v.data());
        return state_;
    }

private:
    Acceleration acceleration_;
    Net::State state_;
    Vector q_, p_;
    boost::numeric::odeint::symplectic_euler<Vector> stepper_;
};

/// Boost.odeint's dopri5 with steps by its own error control; y = (x, v).
class OdeintDopri5 {
public:
    OdeintDopri5(const Net& net, double tolerance)
        : acceleration_(net),
          state_(net.initial_state()),
          half_(static_cast<std::size_t>(state_.x.size())),
          y_(state_.x.data(), state_.x.data() + state_.x.size()),
          stepper_(boost::numeric::odeint::make_controlled(
              tolerance, tolerance, boost::numeric::odeint::runge_kutta_dopri5<Vector>())) {
        y_.resize(2 * half_, 0);
    }
    /// Moves on by `frame`, s. Returns the tries at a step, 0 when the steps shrink to nothing.
    taut::Index advance(double frame) {
        const auto rate_of = [this](const Vector& y, Vector& rate, double) {
            std::copy(y.begin() + static_cast<std::ptrdiff_t>(half_), y.end(), rate.begin());
            acceleration_(y.data(), rate.data() + half_);
        };
        taut::Index tries = 0;
        double t = 0;
        while (t < frame) {
            if (h_ < 1e-9) return 0;
            ++tries;
            if (h_ < frame - t) {
                stepper_.try_step(rate_of, y_, t, h_);
            } else {  // the rest of the frame says nothing about the next step
                double rest = frame - t;
                const auto result = stepper_.try_step(rate_of, y_, t, rest);
                if (result == boost::numeric::odeint::success) return tries;
                h_ = rest;
            }
        }
        return tries;
    }
    const Net::State& state() {
        const auto middle = y_.begin() + static_cast<std::ptrdiff_t>(half_);
        std::copy(y_.begin(), middle, state_.x.data());
        std::copy(middle, y_.end(), state_.v.data());
        return state_;
    }

private:
    Acceleration acceleration_;
    Net::State state_;
    std::size_t half_;  // entries of x
    Vector y_;
    decltype(boost::numeric::odeint::make_controlled(
        0., 0., boost::numeric::odeint::runge_kutta_dopri5<Vector>())) stepper_;
    double h_ = 1e-5;  // s
};

}  // namespace bench
