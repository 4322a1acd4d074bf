// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "contact.hpp"
#include "detail/ball_list.hpp"
#include "detail/ball_step.hpp"

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
    using Layout = step_detail::Layout<Scalar>;
    using Memory = step_detail::StateMemory<Scalar>;

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
        if (&bodies.system() != &system) fail("SelfContact: the bodies are of another system");
        bodies_ = &bodies;
    }

    /// Of a particle's ball, m. Unchecked: 0 ≤ i < size().
    Scalar radius(Index i) {
        renew();
        return near_.pairs.radius[i];
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
        answer.certified = list(state) ? certified(near_.load(), limit_.certified) : Scalar(0);
        return answer;
    }
    /// ½κ(R − l)₊² of all pairs at a state, J; NaN if that is not finite.
    double energy(const State& state) {
        renew();
        if (!list(state)) return std::numeric_limits<double>::quiet_NaN();
        measure(state, asked_);
        return asked_.energy;
    }
    /// The same at the end of the last frame.
    double energy() const { return chosen_.energy; }
    /// Pairs that touch there.
    Index touching() const { return chosen_.touching; }
    /// How far the deepest of them overlaps, m.
    Scalar deepest() const { return static_cast<Scalar>(chosen_.deepest); }
    /// What pins that move did through pairs in the last frame, −Σ h u·f, J.
    double work() const { return chosen_.work; }
    /// How often near pairs were looked up anew.
    Index lookups() const { return near_.lookups(); }

    /// The system whose particles these are.
    const System& system() const { return *system_; }

    // What follows is for steppers.

    /// First in a frame. @returns what pairs and bodies hold of each particle, J: at `state`, later
    /// at the end of the last try, and then of what was chosen
    const Buffer<double>& open(const State& state) {
        renew();
        tries_ = 0;
        proved_ = limit_.certified;
        last_most_ = std::exchange(most_, Scalar(0));
        if (bodies_) bodies_held_ = &bodies_->open(state);
        const bool settled = settled_x_.cols() == state.x.cols() && settled_x_ == state.x;
        if (!list(state, settled)) {
            begun_.held.assign(system_->size(), 0);
            return add_bodies(begun_);
        }
        most_ = near_.load();
        if (settled) {
            begun_ = chosen_;
        } else {
            measure(state, begun_);
        }
        return add_bodies(begun_);
    }
    /// The longest step that is proved with pairs, s. @param proved  the same without them, in
    /// place of energy_limit's
    Scalar longest(Scalar proved) {
        proved_ = proved;
        return longest();
    }
    /// The same, of the step that it was last asked for.
    Scalar longest() const { return certified((std::max)(most_, last_most_), proved_); }
    /// The first, or another, try of a frame of `count` steps of h, s. @param books  sees the
    /// states between steps, too; may be null
    void begin(Scalar h, Index count, step_detail::StepWatch<Scalar, Dim>* books) {
        ++tries_;
        h_ = h;
        count_ = count;
        passed_ = 0;
        waits_ = stopped_ = crowded_ = restless_ = false;
        books_ = bodies_ ? bodies_ : books;
        if (bodies_) bodies_->begin(h, count, books);
        step_.begin(system_->size());
    }
    /// Why a try ended early, if it can be mended: more pairs were near than are proved for h, of
    /// which longest() knows now; or bodies pushed particles farther than was looked, which will
    /// be.
    bool wants_another() const { return crowded_ || restless_; }
    /// After all its steps. @returns the work on each particle, J
    const Buffer<double>& end() {
        auto& outcome = outcomes_[tries_ > 1];
        outcome.work = 0;
        for (const double work : step_.work) outcome.work += work;
        if (tries_ == 1) chosen_ = outcome;
        if (bodies_) {
            const auto& of_bodies = bodies_->end();
            for (Index i = 0; i < system_->size(); ++i) step_.work[i] += of_bodies[i];
        }
        add_bodies(outcome);
        return step_.work;
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
        by_step_ = (std::max)(Scalar(0.9) * by_step_, Scalar(1));
    }

    /// The state between two steps.
    void see(const Places& x, const Places& v, Scalar time, const State* state,
             const Points<Scalar, Dim>* force) override {
        // A stepper that seeks a step that failed shows where it began once more.
        stopped_ = stopped_ || std::exchange(waits_, true);
        if (books_) books_->see(x, v, time, state, force);
    }
    /// Pairs, then bodies, of a step, on what it came to without.
    bool passed(const Layout& layout, const Buffer<int>& places, Memory& memory, Scalar now,
                Scalar ahead) override {
        waits_ = false;
        if (stopped_) return false;
        if (Index(places.size()) != system_->size())
            fail("SelfContact: this is of another system than the stepper");
        stopped_ = true;  // unless this is one more
        const bool ends = passed_ == count_, first = passed_ == 0, last = ++passed_ == count_;
        const auto& planes = memory.planes();
        if (near_.pairs.widest() > 0) {
            const auto& x = ends ? planes.new_x : planes.x;  // accelerations have the place of x
            const typename Step::Where where{places,
                                             {layout, x},
                                             {layout, planes.v},
                                             ends ? Scalar(0) : h_,
                                             {layout, ahead > 0 ? planes.new_spring_x : x},
                                             ahead};
            // Of velocity Verlet the first and the last kick are half ones.
            const Scalar time = ahead > 0 || !(first || ends) ? h_ : h_ / 2;
            if (ends) {
                step_.push(near_.pairs, where, time);
            } else if (!push(layout, memory, where, time, first)) {
                return false;
            }
            step_.apply(where, {layout, planes.spring_x}, ends ? Scalar(0) : h_);
        }
        if (bodies_ && !bodies_->passed(layout, places, memory, now, ahead)) return false;
        if (near_.pairs.widest() > 0 && !ends && bodies_) {
            near_.look(layout, planes.x.first);
            if (!near_.covers(0)) {
                by_step_ *= 2;
                restless_ = detail::is_finite(by_step_);
                return false;
            }
        }
        if (last)
            Step::measure(near_.pairs, Places(layout, places, planes.x), outcomes_[tries_ > 1]);
        stopped_ = false;
        return true;
    }

private:
    using Step = contact_detail::BallStep<Scalar, Dim>;

    void renew() {
        if (revision_ == system_->revision() + 1) return;
        revision_ = system_->revision() + 1;
        near_.forget();
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
        near_.pairs.by_mass =
            static_cast<Scalar>(left / (2 * q * q * h * h * static_cast<double>(options_.pairs)));
        set_balls();
    }
    void set_balls() {
        const Index count = system_->size();
        near_.pairs.radius.assign(count, Scalar(0));
        near_.pairs.inverse_mass.resize(count);
        const auto shorten = [&](Index i, Scalar length) {
            Scalar& radius = near_.pairs.radius[i];
            if (length > 0 && !(radius > 0 && radius < length)) radius = length;
        };
        system_->visit_springs([&](const auto& spring) {
            shorten(spring.a, spring.rest_length);
            shorten(spring.b, spring.rest_length);
        });
        for (Index i = 0; i < count; ++i) {
            near_.pairs.radius[i] *= static_cast<Scalar>(options_.radius);
            near_.pairs.inverse_mass[i] = system_->inverse_mass()[i];
        }
        near_.pairs.reserve(options_.pairs);
        near_.pairs.exclude([&](const auto& visit) { system_->for_each_spring(visit); });
    }
    /// The largest step, s, with that load of near_, of steps that are proved up to h without: qh
    /// for which q²(L_k and D) + q(1 − q)(D) + 2q²(load) is 1.
    Scalar certified(Scalar load, Scalar proved) const {
        if (!(load > 0)) return proved;
        const auto h = static_cast<double>(proved);
        const double d = (std::min)(1.0, h * damping_);
        const double a = 1 - d + 2 * h * h * static_cast<double>(near_.pairs.by_mass * load);
        const double q = 2 / (d + std::sqrt(d * d + 4 * a));
        return (std::min)(proved, proof_detail::round_down<Scalar>(q * h));
    }
    Scalar stiffness_of(Index i, Index j) const {
        const Scalar w = (std::max)(near_.pairs.inverse_mass[i], near_.pairs.inverse_mass[j]);
        return w > 0 ? near_.pairs.by_mass / w : Scalar(0);
    }
    void measure(const State& state, contact_detail::Overlap& overlap) {
        const auto x = [&](Index i) -> Vector { return state.x.col(i); };
        Step::measure(near_.pairs, x, overlap);
    }

    /// Counts the pairs near a state. @param settled  whether the last frame ended there
    /// @returns false where it is not finite
    bool list(const State& state, bool settled = false) {
        if (state.x.cols() != system_->size() || !detail::all_finite(state.x)) return false;
        near_.list(state.x, settled);
        return true;
    }
    /// Finds what pairs do in a step, once all that may touch in it count.
    /// @returns whether h is proved with them
    bool push(const Layout& layout, Memory& memory, const typename Step::Where& where, Scalar time,
              bool first) {
        if (first) near_.start(layout, memory, h_);
        near_.look(layout, memory.planes().x.first);
        const Scalar spare = bodies_ ? by_step_ * near_.pairs.widest() / 8 : Scalar(0);
        for (Scalar more = spare;;) {
            const bool reaches = near_.count(more);
            crowded_ = reaches && where.ahead > 0 && h_ > certified(near_.load(), proved_);
            if (reaches && !crowded_) {
                step_.push(near_.pairs, where, time);
                more = spare + 2 * h_ * step_.largest_kick();
                if (near_.covers(more)) return true;
            } else if (crowded_ && near_.is_young()) {
                most_ = Scalar(1.25) * near_.load();  // there will be some more
                return false;
            } else if (!near_.look_back(layout, memory, h_, more)) {
                return false;
            }
        }
    }
    const Buffer<double>& add_bodies(const contact_detail::Overlap& own) {
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
    contact_detail::BallList<Scalar, Dim> near_;
    Scalar by_step_ = 1;               // how far bodies may push, by what is usual
    Scalar most_ = 0, last_most_ = 0;  // load of this frame and the last one
    // Of a try.
    step_detail::StepWatch<Scalar, Dim>* books_ = nullptr;
    Scalar h_ = 0, proved_ = 0;     // s; without pairs
    Index count_ = 0, passed_ = 0;  // steps
    bool waits_ = false, stopped_ = false, crowded_ = false, restless_ = false;
    Step step_;
    // Of frames.
    int tries_ = 0;
    Buffer<double> held_;                          // with bodies, J
    const Buffer<double>* bodies_held_ = nullptr;  // theirs, J
    detail::Few<contact_detail::Overlap, 2> outcomes_;
    contact_detail::Overlap begun_, chosen_, asked_;
    Points<Scalar, Dim> settled_x_;  // m
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
