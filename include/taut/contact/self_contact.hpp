// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "../integrator/energy_stable_euler.hpp"
#include "../proof/energy_limit.hpp"
#include "detail/ball_pairs.hpp"
#include "detail/motion.hpp"

namespace taut {

/// How the particles of a SpringSystem keep apart from each other.
struct SelfContactOptions {
    double budget = 0.1;  ///< the share of energy_limit that pairs may take, > 0 and < 1
    double radius = 0.5;  ///< of a particle's ball, in lengths of its shortest spring at rest, ≥ 0
    Index pairs = 8;      ///< of one particle that the budget is for, ≥ 1
};

/// Cloth on cloth, inside the step [T42]: a ball around every particle, and between two balls that
/// overlap, unless a spring joins their particles, a force along the line of their centres,
///
///     T = −κ(R − l)₊,   R = r_i + r_j,   κ_ij = κ₁·min(m_i, m_j).
///
/// Such a pair is a spring that only pushes, and the step of EnergyStableEuler covers it: with its
/// length at y = x + h v taken along its direction n at x, l = n·y, which does not forget a pair
/// that passes through,
///
///     M ⪰ h²(L_k + L_κ) + ½hD   gives   H⁺ − H ≤ W,   H with ½κ(R − l)₊² of every pair.
///
/// Stiffness costs a part of the step, and the user says which: κ₁ is what leaves
/// (1 − budget)·energy_limit certified as long as no particle has more than `pairs` others near.
/// Where more are near steps are shorter, and κ stays as it is. limit() tells the step.
///
/// Cloths that are to touch are one system, which takes one common step: in turn, each with the
/// other at rest, they gain energy. A pin in a pair is a ball with its velocity, and the work that
/// it does is booked.
///
/// Not promised: that nothing passes. Balls overlap as far as κ lets them, about v·√(m/Σκ) of a
/// speed v; at more than R of that they go through. Between balls there is nothing: a point
/// that meets a triangle in its middle is held only where balls reach so far, R ≥ s/√2 for
/// squares of the side s; edges likewise. There is no friction.
template <class System>
class SelfContact final : public step_detail::StepWatch<typename System::Scalar, System::Dim> {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using State = taut::State<Scalar, Dim>;

    /// Keeps a reference: the system must outlive this. Options out of range go to fail().
    explicit SelfContact(const System& system, const SelfContactOptions& options = {})
        : system_(&system), options_(options) {
        require_positive("SelfContact", "budget", options.budget);
        require_non_negative("SelfContact", "radius", options.radius);
        if (!(options.budget < 1))
            fail("SelfContact: budget is ", options.budget, "; it must be < 1");
        if (options.pairs < 1) fail("SelfContact: pairs is ", options.pairs, "; it must be >= 1");
    }
    explicit SelfContact(const System&&, const SelfContactOptions& = {}) = delete;

    /// Of a particle's ball, m. Unchecked: 0 ≤ i < size().
    Scalar radius(Index i) {
        renew();
        return near_.radius[i];
    }
    /// κ of a pair that touches, N/m; 0 where a spring joins it or both are pinned.
    Scalar stiffness(Index i, Index j) {
        renew();
        return stiffness_of(i, j);
    }
    /// energy_limit with the pairs that may touch before two particles have moved a quarter of the
    /// widest R towards each other. `certified`, s, is proved, `refuted` is not looked for.
    StepLimit<Scalar> limit(const State& state) {
        renew();
        StepLimit<Scalar> answer = limit_;
        if (!list(state)) return {};
        answer.certified = certified_with(near_.heaviest_load());
        return answer;
    }
    /// ½κ(R − l)₊² of all pairs at a state, J; it also counts them.
    double energy(const State& state) {
        renew();
        if (!list(state)) return std::numeric_limits<double>::quiet_NaN();
        double sum = 0;
        touching_ = 0;
        deepest_ = 0;
        for (const auto& [a, b] : near_.pairs()) {
            const Scalar deep =
                near_.radius[a] + near_.radius[b] - Vector(state.x.col(b) - state.x.col(a)).norm();
            if (!(deep > 0)) continue;
            ++touching_;
            deepest_ = (std::max)(deepest_, deep);
            sum += static_cast<double>(stiffness_of(a, b)) * static_cast<double>(deep) *
                   static_cast<double>(deep) / 2;
        }
        return sum;
    }
    /// Pairs that touched when energy() was last asked.
    Index touching() const { return touching_; }
    /// How far the deepest of them overlapped, m.
    Scalar deepest() const { return deepest_; }
    /// What pins that move did through pairs in the last frame, −Σ h u·f, J.
    double work() const { return work_; }
    /// How often near pairs were looked up anew.
    Index lookups() const { return lookups_; }

    /// For steppers: looks whether the system was edited.
    void renew() {
        if (revision_ == system_->revision() + 1) return;
        revision_ = system_->revision() + 1;
        listed_ = false;
        limit_ = energy_limit(*system_);
        if (limit_.unbounded() || !(limit_.certified > 0)) {
            fail("SelfContact: the system's energy_limit is ", limit_.certified,
                 "; pairs can have a share of a finite step > 0 only");
        }
        const auto h = static_cast<double>(limit_.certified);
        const Pencil halved = Pencil::any_pose(*system_, Pencil::Damping::half);
        damped_ = (std::min)(1.0, h * (std::max)(0.0, halved.upper_bound(matrices::D)));
        const double q = 1 - options_.budget;
        const double left = 1 - q * q - q * (1 - q) * damped_;
        by_mass_ = left / (2 * q * q * h * h * static_cast<double>(options_.pairs));
        set_balls();
    }
    /// Steps of h, s, follow.
    void begin(Scalar h) {
        renew();
        h_ = h;
        work_ = 0;
        stopped_ = crowded_ = false;
        fresh_ = true;
    }
    /// Whether steps were stopped since more pairs were near than h allows.
    bool crowded() const { return crowded_; }
    /// Certified with a quarter more pairs a particle than stopped them, s.
    Scalar shorter() const { return certified_with(near_.heaviest_load() * Scalar(1.25)); }

    void see(const step_detail::PlaceVectors<Scalar, Dim>&,
             const step_detail::PlaceVectors<Scalar, Dim>&, Scalar, const State*,
             const Points<Scalar, Dim>*) override {}
    void before(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                const step_detail::StateMemory<Scalar>& memory, Scalar) override {
        if (stopped_ || !(near_.widest() > 0)) return;
        const auto& planes = memory.planes();
        const auto whole = static_cast<std::size_t>(memory.whole());
        for (auto* of : {&old_x_, &old_y_, &kick_}) of->resize(whole);
        std::copy_n(planes.x.first, whole, old_x_.data());
        std::copy_n(planes.spring_x.first, whole, old_y_.data());
        if (std::exchange(fresh_, false)) {
            detail::set_zero(kick_.data(), memory.whole());
            in_planes_ = false;  // places may have changed
            const bool held = listed_ && detail::all_finite(old_x_.data(), memory.whole()) &&
                              holds(layout, places, old_x_.data());
            if (!held || crowded_with(near_.heaviest_load())) stopped_ = !look_back(layout, places);
            if (stopped_) return;
        }
        push(layout, places);
    }
    bool passed(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                step_detail::StateMemory<Scalar>& memory, Scalar, Scalar ahead) override {
        if (stopped_) return false;
        if (!(near_.widest() > 0)) return true;
        const auto& planes = memory.planes();
        for (bool again = false; !holds(layout, places, planes.x.first); again = true) {
            if (again) by_step_ *= 2;
            if (!again && lived_ > 8) by_step_ = (std::max)(by_step_ / 2, Scalar(1));
            stopped_ = !memory.finite() || !look_back(layout, places);
            if (stopped_) return false;
            push(layout, places);
        }
        ++lived_;
        work_ += step_work_;
        if (!pushes_) return true;
        const Register h(h_), to_y(ahead);
        memory.for_each_register([&](Index i) {
            const Register kick = Register::load(kick_.data() + i);
            const Register v = Register::load(planes.v.first + i) + kick;
            const Register x = Register::load(planes.x.first + i) + h * kick;
            v.store(planes.v.first + i);
            x.store(planes.x.first + i);
            (x + to_y * v).store(planes.spring_x.first + i);
        });
        return true;
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    using Access = contact_detail::PlaneAccess<Scalar, Dim>;
    using Places = step_detail::PlaceVectors<Scalar, Dim>;

    void set_balls() {
        const Index count = system_->size();
        near_.radius.assign(count, Scalar(0));
        near_.inverse_mass.resize(count);
        const auto shorten = [&](Index i, Scalar length) {
            Scalar& radius = near_.radius[i];
            if (length > 0 && !(radius > 0 && radius < length)) radius = length;
        };
        system_->visit_springs([&](const auto& spring) {
            shorten(spring.a, spring.rest_length);
            shorten(spring.b, spring.rest_length);
        });
        for (Index i = 0; i < count; ++i) {
            near_.radius[i] *= static_cast<Scalar>(options_.radius);
            near_.inverse_mass[i] = system_->inverse_mass()[i];
        }
        near_.reserve(options_.pairs);
        near_.exclude([&](const auto& visit) { system_->for_each_spring(visit); });
    }
    /// The largest step, s, with that load of near_: q of limit_ for which
    /// q²(L) + q(1 − q)·(damping) + 2q²h²·(load) is 1.
    Scalar certified_with(Scalar load) const {
        if (!(load > 0)) return limit_.certified;
        const auto h = static_cast<double>(limit_.certified);
        const double a = 1 - damped_ + 2 * h * h * by_mass_ * static_cast<double>(load);
        const double q = 2 / (damped_ + std::sqrt(damped_ * damped_ + 4 * a));
        return (std::min)(limit_.certified, proof_detail::round_down<Scalar>(q * h));
    }
    Scalar stiffness_of(Index i, Index j) const {
        const Scalar w = (std::max)(near_.inverse_mass[i], near_.inverse_mass[j]);
        return w > 0 ? static_cast<Scalar>(by_mass_) / w : Scalar(0);
    }

    /// Lists the pairs near a state, if those that are listed do not hold. @returns false where it
    /// is not finite
    bool list(const State& state) {
        if (state.x.cols() != system_->size() || !detail::all_finite(state.x)) return false;
        if (listed_) {
            const Vector least = (state.x - listed_x_).rowwise().minCoeff();
            const Vector most = (state.x - listed_x_).rowwise().maxCoeff();
            if ((most - least).squaredNorm() < margin_ * margin_) return true;
        }
        build([&](Index i) -> Vector { return state.x.col(i); }, near_.widest() / 4);
        return true;
    }
    template <class Positions>
    void build(const Positions& x, Scalar margin) {
        ++lookups_;
        margin_ = margin;
        near_.build(x, margin);
        listed_x_.resize(Dim, system_->size());
        for (Index i = 0; i < system_->size(); ++i) listed_x_.col(i) = x(i);
        listed_ = true;
        lived_ = 0;
        in_planes_ = false;
    }
    /// Whether no two particles have moved apart by the margin since they were listed, where the
    /// step and its kicks take them: then no pair that is not listed touches.
    bool holds(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
               const Scalar* x) {
        if (!in_planes_ || listed_planes_.size() != kick_.size()) {
            listed_planes_.assign(kick_.size(), Scalar(0));
            const Access to(layout, {listed_planes_.data(), layout.stride()});
            for (Index i = 0; i < layout.size(); ++i) to.set(places[i], listed_x_.col(i));
            in_planes_ = true;
        }
        const Scalar infinity = std::numeric_limits<Scalar>::infinity();
        const Index size = layout.size() * layout.grain();
        Scalar spread2 = 0;
        for (int plane = 0; plane < layout.planes(); ++plane) {
            const Index first = plane * layout.stride();
            std::array<Scalar, 4> least, most;  // of points an axis each
            least.fill(infinity);
            most.fill(-infinity);
            const auto see = [&](Index i, std::size_t lane) {
                const Index at = first + i;
                const Scalar way = x[at] + h_ * kick_[at] - listed_planes_[at];
                least[lane] = (std::min)(least[lane], way);
                most[lane] = (std::max)(most[lane], way);
            };
            Index i = 0;
            for (; i + 4 <= size; i += 4) {
                for (std::size_t lane = 0; lane < 4; ++lane)
                    see(i + static_cast<Index>(lane), lane);
            }
            for (; i < size; ++i) see(i, 0);
            if (!layout.has_stars()) {
                least[0] = *std::min_element(least.begin(), least.end());
                most[0] = *std::max_element(most.begin(), most.end());
            }
            for (std::size_t d = 0; d < (layout.has_stars() ? std::size_t(Dim) : 1); ++d)
                spread2 += (most[d] - least[d]) * (most[d] - least[d]);
        }
        return spread2 < Scalar(0.96) * margin_ * margin_;
    }
    /// Lists pairs where the step began. @returns false where they are too many for h
    bool look_back(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places) {
        const Scalar margin = by_step_ * near_.widest() / 4;
        if (!detail::all_finite(old_x_.data(), static_cast<Index>(old_x_.size())) ||
            !detail::is_finite(margin * margin))
            return false;
        build(Places(layout, places, {old_x_.data(), layout.stride()}), margin);
        crowded_ = crowded_with(near_.heaviest_load());
        return !crowded_;
    }
    bool crowded_with(Scalar load) const { return h_ > certified_with(load); }
    /// The pairs' forces in a step, h/m of them.
    void push(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places) {
        detail::set_zero(kick_.data(), static_cast<Index>(kick_.size()));
        pushes_ = false;
        step_work_ = 0;
        const Access x(layout, {old_x_.data(), layout.stride()});
        const Access y(layout, {old_y_.data(), layout.stride()});
        const Access kick(layout, {kick_.data(), layout.stride()});
        for (const auto& [a, b] : near_.pairs()) {
            const int at = places[a], to = places[b];
            const Scalar R = near_.radius[a] + near_.radius[b];
            Vector n = x.vector(to) - x.vector(at);
            const Scalar l2 = n.squaredNorm();
            if (l2 > (std::numeric_limits<Scalar>::min)()) {
                n /= std::sqrt(l2);
            } else {
                n = Vector::Unit(0);
            }
            const Vector y_a = y.vector(at), y_b = y.vector(to);
            const Scalar deep = R - n.dot(y_b - y_a);
            if (!(deep > 0)) continue;
            pushes_ = true;
            const Vector f = stiffness_of(a, b) * deep * n;  // on b
            const Scalar w_a = near_.inverse_mass[a], w_b = near_.inverse_mass[b];
            kick.set(at, kick.vector(at) - h_ * w_a * f);
            kick.set(to, kick.vector(to) + h_ * w_b * f);
            if (!(w_a > 0)) step_work_ += static_cast<double>(f.dot(y_a - x.vector(at)));
            if (!(w_b > 0)) step_work_ -= static_cast<double>(f.dot(y_b - x.vector(to)));
        }
    }

    const System* system_;
    SelfContactOptions options_;
    std::uint64_t revision_ = 0;  // of what limit_ belongs to, and one
    StepLimit<Scalar> limit_;     // without pairs
    double damped_ = 0;           // the share that damping may have in it
    double by_mass_ = 0;          // κ₁, 1/s²
    Scalar h_ = 0;                // s
    bool fresh_ = false, stopped_ = false, crowded_ = false;
    contact_detail::BallPairs<Scalar, Dim> near_;
    bool listed_ = false;              // whether near_ has its pairs
    bool in_planes_ = false;           // and listed_planes_ is listed_x_
    Scalar margin_ = 0;                // m, of that list
    Scalar by_step_ = 1;               // the next one's, in widths by default
    Index lived_ = 0;                  // steps that it has held
    Points<Scalar, Dim> listed_x_;     // where particles were, m
    Buffer<Scalar> listed_planes_;     // the same by place
    Buffer<Scalar> old_x_, old_y_;     // planes, where the step began and y, m
    Buffer<Scalar> kick_;              // planes, m/s
    bool pushes_ = false;              // whether any pair does
    double step_work_ = 0, work_ = 0;  // J
    Index touching_ = 0;
    Scalar deepest_ = 0;
    Index lookups_ = 0;
};

/// Takes `count` steps of h, s, with self-contact; where more balls are near each other than h
/// allows, more and shorter ones over the same time, from the start. Of a failed call the state is
/// as it was before.
/// @returns as step(); `iterations` tells how many steps were taken
template <class System, class AnyState>
Report step_through(EnergyStableEuler<System>& stepper, AnyState& state, typename System::Scalar h,
                    Index count, SelfContact<System>& contact) {
    using Scalar = typename System::Scalar;
    const Scalar span = h * static_cast<Scalar>(count);
    const struct Watching {
        EnergyStableEuler<System>& stepper;
        ~Watching() { stepper.watch(nullptr); }
    } watching{stepper};
    stepper.watch(&contact);
    for (;;) {
        contact.begin(h);
        const Report report = stepper.step(state, h, count);
        if (report || !contact.crowded()) return report;
        const Scalar longest = contact.shorter();
        if (!(longest > 0) || !(longest < h)) return report;
        count = static_cast<Index>(std::ceil(span / longest));
        h = span / static_cast<Scalar>(count);
    }
}

}  // namespace taut
