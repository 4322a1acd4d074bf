// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "../integrator/detail/watching.hpp"
#include "../integrator/energy_stable_euler.hpp"
#include "../proof/energy_limit.hpp"
#include "detail/rigid_body.hpp"
#include "detail/tries.hpp"
#include "obstacle_concept.hpp"

namespace taut {

/// Bodies that move, and the particles of a SpringSystem that touch them, inside the step, convex
/// ones [T39] and others [T40]: contact takes nothing off the certified step, however stiff it is,
/// and the energy of a scene rises by no more than the work of the bodies.
///
///     taut::Contacts contacts(cloth);
///     const auto ball = contacts.add(taut::Sphere<float, 3>({0, 0, 0}, 0.3f));
///     contacts.move_to(ball, pose);               // where it is at the end of the frame
///     guard.advance(state, 1.0f / 60, contacts);  // or step_through(stepper, ...)
template <class System>
class Contacts final : public step_detail::StepWatch<typename System::Scalar, System::Dim> {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = Pose<Scalar, Dim>;
    using State = taut::State<Scalar, Dim>;

    /// Keeps a reference: the system must outlive this.
    explicit Contacts(const System& system) : system_(&system) {}
    explicit Contacts(const System&&) = delete;

    /// @param shape  in the body's frame: HalfSpace, Sphere, Capsule, Box, or a class of yours with
    ///               `Surface surface(point) const`, which is asked point by point. If it is not
    ///               convex it says `static constexpr bool convex = false`, and then point −
    ///               distance·normal should be a nearest point of the surface: where it is none, as
    ///               in a corner of what has a thickness, a particle may stick [T40]. A class
    ///               with extent() and inner(), such as Sphere's, is asked less often
    /// @returns the body's index
    /// Fails by name unless options and pose are in range.
    template <class Obstacle>
    Index add(Obstacle shape, const BodyOptions& options = {}, const Place& pose = {}) {
        if constexpr (!detail::ObstacleHas<Obstacle, Vector>::all) {
            require_obstacle<Obstacle, Vector>();
        } else {
            return add_body(std::move(shape), options, pose);
        }
    }
    /// Where a body is at the end of the next frame; it is carried there rigidly, on a straight
    /// line and about one axis. However far: what is in its way is pushed, not passed. Fails by
    /// name unless the pose is finite and its rotation one.
    void move_to(Index body, const Place& pose) {
        if (body < 0 || body >= static_cast<Index>(rigid_.size()))
            fail("Contacts::move_to: there is no body ", body);
        rigid_[static_cast<std::size_t>(body)]->end = rigid("Contacts::move_to", pose);
    }

    /// κ of a particle over its mass, 1/s²: how stiff contact is. It costs no step [T39].
    Scalar stiffness() {
        renew();
        return step_.penalty.by_mass;
    }
    /// Sets it, > 0; else it is 100/h², with h of energy_limit, but at most 0.01 s: so at speed v a
    /// particle comes h·v/10 deep. More than rounding bears, 8 400/h² in float, is not taken. What
    /// touches holds more energy, or less, from then on: an edit between frames.
    void set_stiffness(Scalar by_mass) {
        require_positive("Contacts::set_stiffness", "by_mass", by_mass);
        set_ = by_mass;
        revision_ = 0;
    }

    /// What the bodies did on the particles in the last frame, Σ h ū·f, J.
    double work() const { return sum(settled_.work); }
    /// What touching pairs hold at its end, J.
    double energy() const { return sum(settled_.energy); }
    /// Particles and bodies that touch, at the end of the last step.
    Index touching() const {
        Index count = 0;
        step_.nearby.each_touching(step_.bodies, [&](const auto&) { ++count; });
        return count;
    }
    /// How deep the deepest of them is then, m.
    Scalar deepest() const {
        Scalar depth = 0;
        step_.nearby.each_touching(
            step_.bodies, [&](const auto& pair) { depth = (std::max)(depth, pair.depth); });
        return depth;
    }
    /// How often what is near was looked up anew.
    Index lookups() const { return step_.lookups; }

    /// The system whose particles these are.
    const System& system() const { return *system_; }

    // What follows is for steppers and for sets that particles are kept in.

    /// Adds what is asked like a body.
    void keep(std::unique_ptr<contact_detail::Body<Scalar, Dim>> body) {
        step_.bodies.push_back(std::move(body));
        edited();
    }
    /// What touches holds more energy, or less, from now on.
    void edited() { settled_x_.resize(Dim, 0); }

    /// First in a frame. @returns φ of each particle, J: at `state`, later at the end of the last
    /// try, and then of what was chosen
    const Buffer<double>& open(const State& state) {
        renew();
        tries_ = 0;
        begun_.clear();
        for (const auto& body : step_.bodies) body->open(state);
        if (settled_x_.cols() == state.x.cols() && settled_x_ == state.x) {
            begun_ = settled_.known;
            held_ = settled_.energy;
            return held_;
        }
        held_.assign(system_->size(), 0);
        for (Index i = 0; i < (std::min)(system_->size(), Index(state.x.cols())); ++i)
            held_[i] = energy_at(i, state.x.col(i), false);
        return held_;
    }
    /// The first, or another, try of a frame of `count` steps of h, s.
    /// @param books  sees the states between steps, too; may be null
    void begin(Scalar h, Index count, step_detail::StepWatch<Scalar, Dim>* books) {
        ++tries_;
        books_ = books;
        count_ = count;
        passed_ = 0;
        waits_ = false;
        failed_ = false;
        step_.penalty.h = h;
        step_.nearby.clear();
        step_.work.assign(system_->size(), Scalar(0));
        const Scalar frame = h * static_cast<Scalar>(count);
        drift_ = Vector::Zero();
        for (const auto& body : step_.bodies) {
            const Vector way = body->start(frame);
            drift_ += way / (frame * static_cast<Scalar>(step_.bodies.size()));
        }
        // Far enough for some part of a frame in which bodies hurry, and a short list where not.
        Scalar most = 0;
        for (const auto& body : step_.bodies)
            most = (std::max)(most, body->frame_reach(frame * drift_));
        margin_ = (std::min)((std::max)(most / 8, Scalar(0.004)), Scalar(0.01));
    }
    /// After all its steps. @returns the work on each particle, J
    const Buffer<double>& end() {
        contact_detail::Outcome& outcome = outcomes_[tries_ > 1];
        outcome.take(step_, particle_);
        if (tries_ == 1) choose([](Index) { return false; });
        return outcome.work;
    }
    /// Takes for each particle the first or the last try; after one try this is done.
    /// @param last  last(i): whether the last one
    template <class Last>
    void choose(const Last& last) {
        const auto of = [&](Index i) { return tries_ > 1 && last(i); };
        work_.resize(system_->size());
        for (Index i = 0; i < system_->size(); ++i) {
            work_[i] = outcomes_[of(i)].work[i];
            held_[i] = outcomes_[of(i)].energy[i];
        }
        known_.clear();
        for (int each = 0; each < 2; ++each) {
            for (const auto& pair : outcomes_[each].known) {
                if (of(pair.at) == bool(each)) known_.push_back(pair);
            }
        }
    }
    /// Particle i stays at x, where the frame began, m.
    void stay(Index i, const Vector& x) {
        work_[i] = 0;
        held_[i] = energy_at(i, x, true);
        const auto of_it = [&](const auto& pair) { return pair.at == i; };
        known_.erase(std::remove_if(known_.begin(), known_.end(), of_it), known_.end());
    }
    /// The frame is over, and left this state.
    void settle(const State& state) {
        settled_.work = work_;
        settled_.energy = held_;
        settled_.known = known_;
        settled_x_ = state.x;
        for (const auto& body : step_.bodies) body->settle();
    }

    /// The state between two steps.
    void see(const step_detail::PlaceVectors<Scalar, Dim>& x,
             const step_detail::PlaceVectors<Scalar, Dim>& v, Scalar time, const State* state,
             const Points<Scalar, Dim>* force) override {
        // A stepper that seeks a step that failed shows where it began once more.
        failed_ = failed_ || std::exchange(waits_, true);
        if (books_) books_->see(x, v, time, state, force);
    }
    /// Contact of a step, on what it came to without.
    bool passed(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                step_detail::StateMemory<Scalar>& memory, Scalar, Scalar ahead) override {
        waits_ = false;
        if (failed_) return false;
        const auto& planes = memory.planes();
        const contact_detail::Moving<Scalar, Dim> moving{
            {layout, planes.x}, {layout, planes.v}, {layout, planes.spring_x}, ahead};
        if (passed_ == count_) {
            step_.stop(moving.v);
            return true;
        }
        if (passed_ == 0) {
            if (Index(places.size()) != system_->size())
                fail("Contacts: these are of another system than the stepper");
            know(places);
        }
        ++passed_;
        const Scalar share = static_cast<Scalar>(passed_) / static_cast<Scalar>(count_);
        const Scalar time = static_cast<Scalar>(passed_) * step_.penalty.h;
        for (const auto& body : step_.bodies) body->go_to(share);
        step_.nearby.go_to(step_.bodies, time);
        // What ends within reach, began so: it has met no body that does not list it.
        bool listed = step_.nearby.built();
        for (Scalar margin = margin_;; margin *= 4) {
            if (!listed) {
                if (!detail::is_finite(margin)) return !(failed_ = true);
                if (step_.nearby.built()) step_.nearby.remember(step_.bodies, step_.known);
                step_.look_back(layout, planes, margin, longest_, drift_, time);
                step_.nearby.go_to(step_.bodies, time);
            }
            step_.touch(moving);
            listed = step_.nearby.holds(moving.x, layout.size());
            if (listed) break;
            step_.undo(moving);
        }
        step_.accept();
        return true;
    }

private:
    template <class Obstacle>
    Index add_body(Obstacle&& shape, const BodyOptions& options, const Place& pose) {
        require_held<Scalar>("Contacts::add", "friction", options.friction);
        require_held<Scalar>("Contacts::add", "thickness", options.thickness);
        require_positive("Contacts::add", "push_out", static_cast<Scalar>(options.push_out));
        using Own = contact_detail::BodyOf<Scalar, Dim, Obstacle>;
        auto body = std::make_unique<Own>(std::move(shape), options, rigid("Contacts::add", pose));
        rigid_.push_back(body.get());
        keep(std::move(body));
        return static_cast<Index>(rigid_.size()) - 1;
    }
    /// The pose with the nearest rotation: what is rigid but for rounding would do work far from
    /// the body's origin.
    static Place rigid(const char* function, Place pose) {
        using Rotation = typename Place::Rotation;
        Rotation& R = pose.rotation;
        const Rotation one = Rotation::Identity();
        // Of a distance beyond numbers no body comes back.
        if (!(pose.position.squaredNorm() < (std::numeric_limits<Scalar>::max)()) ||
            !((R.transpose() * R - one).norm() < Scalar(1e-3)) || !(R.determinant() > 0)) {
            fail(function, ": the pose is not finite, or does more than turn and shift");
        }
        for (int i = 0; i < 3; ++i) R = (R * (3 * one - R.transpose() * R) / 2).eval();
        return pose;
    }
    /// Follows edits of the system.
    void renew() {
        if (revision_ == system_->revision() + 1) return;
        revision_ = system_->revision() + 1;
        const Scalar limit = energy_limit(*system_).certified;
        longest_ = (std::min)(limit, Scalar(0.01));
        // More is lost in the rounding of a particle that several bodies press.
        const Scalar most = Scalar(1e-3) / std::numeric_limits<Scalar>::epsilon();
        const Scalar by_h2 = 1 / (longest_ * longest_);
        Scalar& by_mass = step_.penalty.by_mass;
        by_mass = set_ > 0 ? (std::min)(set_, most * by_h2) : 100 * by_h2;
        if (detail::is_finite(limit)) by_mass = (std::min)(by_mass, 50 * most / limit / limit);
        settled_x_.resize(Dim, 0);
    }
    /// Before the first step.
    void know(const Buffer<int>& places) {
        step_.mass.assign(system_->size(), 0);
        particle_.resize(system_->size());
        for (Index i = 0; i < system_->size(); ++i) {
            particle_[places[i]] = static_cast<int>(i);
            if (!system_->is_pinned(i)) step_.mass[places[i]] = system_->mass(i);
        }
        step_.known = begun_;
        for (auto& pair : step_.known) pair.at = places[pair.at];
        for (const auto& body : step_.bodies) body->know(places);
        std::sort(step_.known.begin(), step_.known.end());
    }
    /// φ of a particle that comes new to x, m, at the begin or end of a frame, J.
    double energy_at(Index i, const Vector& x, bool end) const {
        double sum = 0;
        if (system_->is_pinned(i)) return sum;
        for (const auto& body : step_.bodies)
            sum += body->energy(step_.penalty, longest_, i, x, system_->mass(i), end);
        return sum;
    }
    static double sum(const Buffer<double>& of) {
        double sum = 0;
        for (const double each : of) sum += each;
        return sum;
    }

    const System* system_;
    std::uint64_t revision_ = 0;  // of what longest_ belongs to, and one
    Scalar longest_ = 0;          // step of energy_limit, but at most 0.01, s
    Scalar set_ = 0;              // κ/m, 1/s², if > 0
    contact_detail::ContactStep<Scalar, Dim> step_;
    std::vector<contact_detail::RigidBody<Scalar, Dim>*> rigid_;  // of its bodies
    // Of a try.
    int tries_ = 0;
    step_detail::StepWatch<Scalar, Dim>* books_ = nullptr;
    Index count_ = 0, passed_ = 0;         // steps
    bool waits_ = false, failed_ = false;  // for the end of a step; since a step that did
    Scalar margin_ = 0;                    // m
    Vector drift_ = Vector::Zero();        // of the bodies, m/s
    Buffer<int> particle_;                 // at each place
    detail::Few<contact_detail::Outcome, 2> outcomes_;
    // Of frames.
    Buffer<double> held_, work_;  // J
    std::vector<contact_detail::KnownPair> begun_, known_;
    contact_detail::Outcome settled_;
    Points<Scalar, Dim> settled_x_;  // m
};

/// Takes `count` steps of h, s, one frame for the bodies.
template <class System>
Report step_through(EnergyStableEuler<System>& stepper, typename System::State& state,
                    typename System::Scalar h, Index count, Contacts<System>& contacts) {
    if (count <= 0) return stepper.step(state, h, count);
    contacts.open(state);
    contacts.begin(h, count, nullptr);
    const integrator_detail::Watching watching(stepper, &contacts);
    const Report report = stepper.step(state, h, count);
    if (!report) return report;
    contacts.end();
    contacts.settle(state);
    return report;
}

}  // namespace taut
