// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "contact.hpp"
#include "detail/ball_pairs.hpp"

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
    using Places = step_detail::PlaceVectors<Scalar, Dim>;

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
    /// With bodies that the same particles touch, in the same steps. Keeps a reference to both.
    SelfContact(const System& system, Contacts<System>& bodies,
                const SelfContactOptions& options = {})
        : SelfContact(system, options) {
        bodies_ = &bodies;
    }

    /// Of a particle's ball, m. Unchecked: 0 ≤ i < size().
    Scalar radius(Index i) {
        renew();
        return near_.radius[i];
    }
    /// κ of a pair, N/m; 0 if both are pinned. One that a spring joins has no force.
    Scalar stiffness(Index i, Index j) {
        renew();
        return stiffness_of(i, j);
    }
    /// energy_limit with the pairs that may touch before two particles have moved a quarter of the
    /// widest R towards each other. `certified`, s, is proved, `refuted` is not looked for.
    StepLimit<Scalar> limit(const State& state) {
        renew();
        StepLimit<Scalar> answer = limit_;
        answer.certified =
            list(state) ? certified(near_.heaviest_load(), limit_.certified) : Scalar(0);
        return answer;
    }
    /// ½κ(R − l)₊² of all pairs at a state, J.
    double energy(const State& state) {
        renew();
        if (!list(state)) return std::numeric_limits<double>::quiet_NaN();
        share_energy([&](Index i) -> Vector { return state.x.col(i); }, asked_);
        return asked_.energy;
    }
    /// The same at the end of the last frame.
    double energy() const { return chosen_.energy; }
    /// Pairs that touch there.
    Index touching() const { return chosen_.touching; }
    /// How far the deepest of them overlaps, m.
    Scalar deepest() const { return chosen_.deepest; }
    /// What pins that move did through pairs in the last frame, −Σ h u·f, J.
    double work() const { return chosen_.own_work; }
    /// How often near pairs were looked up anew.
    Index lookups() const { return lookups_; }

    // What follows is for steppers.

    /// First in a frame. @returns what pairs and bodies hold of each particle, J: at `state`, later
    /// at the end of the last try, and then of what was chosen
    const Buffer<double>& open(const State& state) {
        renew();
        tries_ = 0;
        proved_ = limit_.certified;
        last_most_ = std::exchange(most_, Scalar(0));
        if (bodies_) bodies_held_ = &bodies_->open(state);
        if (!list(state)) {
            begun_.held.assign(system_->size(), 0);
            return add_bodies(begun_);
        }
        most_ = near_.heaviest_load();
        if (settled_x_.cols() != state.x.cols() || settled_x_ != state.x) {
            share_energy([&](Index i) -> Vector { return state.x.col(i); }, begun_);
        } else {
            begun_ = chosen_;
        }
        return add_bodies(begun_);
    }
    /// The longest step that is proved with pairs, s. @param proved  the same without them, in
    /// place of energy_limit's
    Scalar longest(Scalar proved) {
        proved_ = proved;
        return longest();
    }
    Scalar longest() const { return certified((std::max)(most_, last_most_), proved_); }
    /// The first, or another, try of a frame of `count` steps of h, s. @param books  sees the
    /// states between steps, too; may be null
    void begin(Scalar h, Index count, step_detail::StepWatch<Scalar, Dim>* books) {
        ++tries_;
        h_ = h;
        count_ = count;
        passed_ = 0;
        work_.assign(system_->size(), 0);
        fresh_ = true;
        waits_ = stopped_ = crowded_ = restless_ = false;
        books_ = bodies_ ? bodies_ : books;
        if (bodies_) bodies_->begin(h, count, books);
        old_x_.resize(Dim, system_->size());
        old_y_.resize(Dim, system_->size());
        kick_.setZero(Dim, system_->size());
        is_hit_.assign(system_->size(), 0);
        hit_.clear();
    }
    /// Why a try ended early, if it can be mended: more pairs were near than are proved for h, of
    /// which longest() knows now; or bodies pushed particles farther than the list of pairs
    /// reaches, which it will.
    bool wants_another() const { return crowded_ || restless_; }
    /// After all its steps. @returns the work on each particle, J
    const Buffer<double>& end() {
        Outcome& outcome = outcomes_[tries_ > 1];
        share_energy([&](Index i) -> Vector { return old_x_.col(i); }, outcome);
        outcome.own_work = 0;
        for (const double work : work_) outcome.own_work += work;
        if (tries_ == 1) chosen_ = outcome;
        if (bodies_) {
            const auto& of_bodies = bodies_->end();
            for (Index i = 0; i < system_->size(); ++i) work_[i] += of_bodies[i];
        }
        add_bodies(outcome);
        return work_;
    }
    /// Takes the first or the last try, for all particles the same. @param last  last(i)
    template <class Last>
    void choose(const Last& last) {
        bool other = false;
        for (Index i = 0; i < system_->size(); ++i)
            other = other || (!system_->is_pinned(i) && last(i));
        chosen_ = outcomes_[tries_ > 1 && other];
        if (bodies_) bodies_->choose(last);
        add_bodies(chosen_);
    }
    /// Particle i, and all, stays at x, where the frame began, m.
    void stay(Index i, const Vector& x) {
        if (bodies_) bodies_->stay(i, x);
        chosen_ = begun_;
        add_bodies(chosen_);
    }
    /// The frame is over, and left this state.
    void settle(const State& state) {
        if (bodies_) bodies_->settle(state);
        settled_x_ = state.x;
    }

    void see(const Places& x, const Places& v, Scalar time, const State* state,
             const Points<Scalar, Dim>* force) override {
        // A stepper that seeks a step that failed shows where it began once more.
        stopped_ = stopped_ || std::exchange(waits_, true);
        if (books_) books_->see(x, v, time, state, force);
        for (Index i = 0; i < system_->size(); ++i) {
            old_x_.col(i) = x(i);
            old_y_.col(i) = v(i);
        }
    }
    bool passed(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                step_detail::StateMemory<Scalar>& memory, Scalar time, Scalar ahead) override {
        waits_ = false;
        if (stopped_) return false;
        const auto& planes = memory.planes();
        const Places x(layout, places, planes.x), v(layout, places, planes.v);
        const auto at_rest = [&](Index i) -> Vector { return x(i); };
        // Of velocity Verlet the first and the last kick are half ones.
        const bool ends = passed_ == count_;
        kick_time_ = ahead > 0 || (passed_ > 0 && !ends) ? h_ : h_ / 2;
        if (ahead > 0) old_y_ = old_x_ + ahead * old_y_;
        const auto& y = ahead > 0 ? old_y_ : old_x_;
        ++passed_;
        ahead_ = ahead;
        if (near_.widest() > 0) {
            if (std::exchange(fresh_, false)) {
                const auto old = [&](Index i) -> Vector { return old_x_.col(i); };
                const bool held = listed_ && holds(old, 1);
                if ((!held || too_many()) && !look_back()) return false;
            }
            push(y);
            if (!ends) {
                const auto kicked = [&](Index i) -> Vector { return x(i) + h_ * kick_.col(i); };
                // Bodies may push farther.
                const Scalar part = bodies_ ? Scalar(0.7) : Scalar(1);
                for (bool again = false; !holds(kicked, part); again = true) {
                    if (again) by_step_ *= 2;
                    if (!again && lived_ > 8) by_step_ = (std::max)(by_step_ / 2, Scalar(1));
                    if (!memory.finite() || !look_back()) return !(stopped_ = true);
                    push(y);
                }
            }
            ++lived_;
            for (const auto& [i, work] : step_work_) work_[i] += work;
            const Places spring_x(layout, places, planes.spring_x);
            for (const int i : hit_) {
                const Vector now = v(i) + kick_.col(i);
                v.set(i, now);
                if (ends) continue;
                x.set(i, x(i) + h_ * kick_.col(i));
                if (ahead > 0) spring_x.set(i, x(i) + ahead * now);
            }
        }
        if (!bodies_) return true;
        stopped_ = !bodies_->passed(layout, places, memory, time, ahead);
        if (stopped_ || ends || !(near_.widest() > 0)) return !stopped_;
        if (holds(at_rest, 1)) return true;
        by_step_ *= 2;
        listed_ = false;
        restless_ = detail::is_finite(by_step_);
        return !(stopped_ = true);
    }

private:
    void renew() {
        if (revision_ == system_->revision() + 1) return;
        revision_ = system_->revision() + 1;
        listed_ = false;
        settled_x_.resize(Dim, 0);
        most_ = 0;
        limit_ = energy_limit(*system_);
        if (limit_.unbounded() || !(limit_.certified > 0)) {
            fail("SelfContact: the system's energy_limit is ", limit_.certified,
                 "; pairs can have a share of a finite step > 0 only");
        }
        const auto h = static_cast<double>(limit_.certified);
        const Pencil halved = Pencil::any_pose(*system_, Pencil::Damping::half);
        damping_ = (std::max)(0.0, halved.upper_bound(matrices::D));
        const double q = 1 - options_.budget;
        const double left = 1 - q * q - q * (1 - q) * (std::min)(1.0, h * damping_);
        by_mass_ = left / (2 * q * q * h * h * static_cast<double>(options_.pairs));
        set_balls();
    }
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
    /// The largest step, s, with that load of near_, of steps that are proved up to h without: qh
    /// for which q²(L_k and D) + q(1 − q)(D) + 2q²(load) is 1.
    Scalar certified(Scalar load, Scalar proved) const {
        if (!(load > 0)) return proved;
        const auto h = static_cast<double>(proved);
        const double d = (std::min)(1.0, h * damping_);
        const double a = 1 - d + 2 * h * h * by_mass_ * static_cast<double>(load);
        const double q = 2 / (d + std::sqrt(d * d + 4 * a));
        return (std::min)(proved, proof_detail::round_down<Scalar>(q * h));
    }
    /// Whether pairs are too many for h, as far as it is proved without them.
    bool too_many() {
        if (!(ahead_ > 0)) return false;
        crowded_ = h_ > certified(near_.heaviest_load(), proved_);
        if (crowded_) most_ = near_.heaviest_load() * Scalar(1.25);  // there will be some more
        return crowded_;
    }
    Scalar stiffness_of(Index i, Index j) const {
        const Scalar w = (std::max)(near_.inverse_mass[i], near_.inverse_mass[j]);
        return w > 0 ? static_cast<Scalar>(by_mass_) / w : Scalar(0);
    }

    /// Lists the pairs near a state, if those that are listed do not hold. @returns false where it
    /// is not finite
    bool list(const State& state) {
        if (state.x.cols() != system_->size() || !detail::all_finite(state.x)) return false;
        const auto x = [&](Index i) -> Vector { return state.x.col(i); };
        if (!(near_.widest() > 0)) return true;
        if (!listed_ || !holds(x, 1)) build(x, near_.widest() / 4);
        return true;
    }
    /// Lists pairs where the step began. @returns false where they are too many for h
    bool look_back() {
        const Scalar margin = by_step_ * near_.widest() / 4;
        const bool finite = detail::all_finite(old_x_) && detail::is_finite(margin * margin);
        if (finite) build([&](Index i) -> Vector { return old_x_.col(i); }, margin);
        stopped_ = !finite || too_many();
        return !stopped_;
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
        most_ = (std::max)(most_, near_.heaviest_load());
    }
    /// Whether no two particles have moved apart by that part of the margin since they were listed:
    /// then no pair that is not listed touches.
    template <class Positions>
    bool holds(const Positions& x, Scalar part) const {
        if (system_->size() == 0) return true;
        Vector least = x(0) - listed_x_.col(0), most = least;
        for (Index i = 1; i < system_->size(); ++i) {
            const Vector way = x(i) - listed_x_.col(i);
            least = least.cwiseMin(way);
            most = most.cwiseMax(way);
        }
        const Scalar far = Scalar(0.98) * part * margin_;
        return (most - least).squaredNorm() < far * far;
    }
    /// The pairs' forces where the step began, by what they do to velocities.
    void push(const Points<Scalar, Dim>& y) {
        for (const int i : hit_) {
            kick_.col(i).setZero();
            is_hit_[i] = 0;
        }
        hit_.clear();
        step_work_.clear();
        const auto add = [&](int i, const Vector& kick) {
            if (!std::exchange(is_hit_[i], 1)) hit_.push_back(i);
            kick_.col(i) += kick;
        };
        const auto way = [&](int pin) -> Vector { return y.col(pin) - old_x_.col(pin); };
        const auto book = [&](int i, Scalar work) {
            if (work != 0) step_work_.push_back({i, static_cast<double>(work)});
        };
        for (const auto& [a, b] : near_.pairs()) {
            Vector n = old_x_.col(b) - old_x_.col(a);
            const Scalar l2 = n.squaredNorm();
            if (l2 > (std::numeric_limits<Scalar>::min)()) {
                n /= std::sqrt(l2);
            } else {
                n = Vector::Unit(0);
            }
            const Scalar deep = near_.radius[a] + near_.radius[b] - n.dot(y.col(b) - y.col(a));
            if (!(deep > 0)) continue;
            const Vector f = stiffness_of(a, b) * deep * n;  // on b
            const Scalar w_a = near_.inverse_mass[a], w_b = near_.inverse_mass[b];
            if (w_a > 0) add(a, -kick_time_ * w_a * f);
            if (w_b > 0) add(b, kick_time_ * w_b * f);
            if (!(w_a > 0)) book(b, f.dot(way(a)));
            if (!(w_b > 0)) book(a, -f.dot(way(b)));
        }
    }
    /// What pairs came to at the end of a try.
    struct Outcome {
        Buffer<double> held;  // of each particle, J
        double energy = 0;    // its sum
        double own_work = 0;  // without bodies, J
        Index touching = 0;
        Scalar deepest = 0;  // m
    };
    struct PairWork {
        int at;
        double work;  // J
    };
    /// The pairs' energy at x, half of it for either particle; all for one beside a pin.
    template <class Positions>
    void share_energy(const Positions& x, Outcome& outcome) {
        outcome.held.assign(system_->size(), 0);
        outcome.energy = 0;
        outcome.touching = 0;
        outcome.deepest = 0;
        for (const auto& [a, b] : near_.pairs()) {
            const Scalar deep = near_.radius[a] + near_.radius[b] - Vector(x(b) - x(a)).norm();
            if (!(deep > 0)) continue;
            ++outcome.touching;
            outcome.deepest = (std::max)(outcome.deepest, deep);
            const auto k = static_cast<double>(stiffness_of(a, b));
            const double held = k * static_cast<double>(deep) * static_cast<double>(deep) / 2;
            outcome.energy += held;
            outcome.held[near_.inverse_mass[a] > 0 ? a : b] += held / 2;
            outcome.held[near_.inverse_mass[b] > 0 ? b : a] += held / 2;
        }
    }
    const Buffer<double>& add_bodies(const Outcome& own) {
        held_ = own.held;
        for (Index i = 0; bodies_ && i < system_->size(); ++i) held_[i] += (*bodies_held_)[i];
        return held_;
    }

    const System* system_;
    SelfContactOptions options_;
    Contacts<System>* bodies_ = nullptr;
    std::uint64_t revision_ = 0;  // of what limit_ belongs to, and one
    StepLimit<Scalar> limit_;     // without pairs
    double damping_ = 0;          // a bound on half of that in M⁻¹D, 1/s
    double by_mass_ = 0;          // κ₁, 1/s²
    contact_detail::BallPairs<Scalar, Dim> near_;
    bool listed_ = false;              // whether near_ has its pairs
    Scalar margin_ = 0;                // m, of that list
    Scalar by_step_ = 1;               // the next one's, by what it is where nothing hurries
    Index lived_ = 0;                  // steps that it has held
    Scalar most_ = 0, last_most_ = 0;  // load of this frame and the last one
    Points<Scalar, Dim> listed_x_;     // where particles were, m
    // Of a try.
    step_detail::StepWatch<Scalar, Dim>* books_ = nullptr;
    Scalar h_ = 0, ahead_ = 0;      // s
    Scalar proved_ = 0;             // s, without pairs
    Index count_ = 0, passed_ = 0;  // steps
    bool fresh_ = false, waits_ = false, stopped_ = false, crowded_ = false, restless_ = false;
    // Of a step.
    Points<Scalar, Dim> old_x_, old_y_;  // where it began; v there, then y; m, m/s
    Scalar kick_time_ = 0;               // s
    Points<Scalar, Dim> kick_;           // m/s
    Buffer<int> hit_, is_hit_;           // particles that have one; of each, whether
    Buffer<PairWork> step_work_;         // of pins
    // Of frames.
    int tries_ = 0;
    Buffer<double> work_, held_;                   // with bodies, J
    const Buffer<double>* bodies_held_ = nullptr;  // theirs, J
    detail::Few<Outcome, 2> outcomes_;
    Outcome begun_, chosen_, asked_;
    Points<Scalar, Dim> settled_x_;  // m
    Index lookups_ = 0;
};

/// Takes `count` steps of h, s, with self-contact and its bodies, one frame for these; where more
/// balls are near each other than h allows, more and shorter ones over the same time, from the
/// start. Of a failed call the state is as it was before.
/// @returns as step(); `iterations` tells how many steps were taken
template <class System>
Report step_through(EnergyStableEuler<System>& stepper, typename System::State& state,
                    typename System::Scalar h, Index count, SelfContact<System>& contact) {
    using Scalar = typename System::Scalar;
    if (count <= 0) return stepper.step(state, h, count);
    const Scalar span = h * static_cast<Scalar>(count);
    const integrator_detail::Watching watching(stepper, &contact);
    contact.open(state);
    for (;;) {
        contact.begin(h, count, nullptr);
        const Report report = stepper.step(state, h, count);
        if (report) {
            contact.end();
            contact.choose([](Index) { return true; });
            contact.settle(state);
        }
        if (report || !contact.wants_another()) return report;
        const Scalar longest = contact.longest();
        if (!(longest > 0)) return report;
        if (longest < h) count = static_cast<Index>(std::ceil(span / longest));
        h = span / static_cast<Scalar>(count);
    }
}

}  // namespace taut
