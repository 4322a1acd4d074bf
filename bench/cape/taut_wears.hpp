// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>

#include "frames.hpp"

namespace bench {

/// Contacts whose depth is seen between steps, too: what Guarded is given in their place.
template <class System>
class SeenContacts final
    : public taut::step_detail::StepWatch<typename System::Scalar, System::Dim> {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using State = taut::State<Scalar, Dim>;
    using Watch = taut::step_detail::StepWatch<Scalar, Dim>;

    explicit SeenContacts(taut::Contacts<System>& contacts) : contacts_(contacts) {}

    /// Into what is kept, after any step of any try, m.
    Scalar deepest() const { return deepest_; }

    taut::Index touching() const { return contacts_.touching(); }
    const auto& open(const State& state) { return contacts_.open(state); }
    void begin(Scalar h, taut::Index count, Watch* books) { contacts_.begin(h, count, books); }
    const auto& end() { return contacts_.end(); }
    template <class Last>
    void choose(const Last& last) {
        contacts_.choose(last);
    }
    void stay(taut::Index i, const typename taut::Contacts<System>::Vector& x) {
        contacts_.stay(i, x);
    }
    void settle(const State& state) { contacts_.settle(state); }
    void see(const taut::step_detail::PlaceVectors<Scalar, Dim>& x,
             const taut::step_detail::PlaceVectors<Scalar, Dim>& v, Scalar time, const State* state,
             const taut::Points<Scalar, Dim>* force) override {
        contacts_.see(x, v, time, state, force);
    }
    bool passed(const taut::step_detail::Layout<Scalar>& layout, const taut::Buffer<int>& places,
                taut::step_detail::StateMemory<Scalar>& memory, Scalar time,
                Scalar ahead) override {
        const bool ok = contacts_.passed(layout, places, memory, time, ahead);
        if (seen_) deepest_ = std::max(deepest_, contacts_.deepest());
        return ok;
    }
    /// From now on.
    void start() { seen_ = true; }

private:
    taut::Contacts<System>& contacts_;
    Scalar deepest_ = 0;
    bool seen_ = false;
};

/// Guarded and Contacts.
template <class System>
class TautWears {
public:
    using Scalar = typename System::Scalar;
    using Shape = taut::Capsule<Scalar, 3>;

    TautWears(const System& system, const std::vector<Round>& bodies, const Places& at,
              const Touch& touch = {})
        : contacts_(system), guard_(system), state_(system.initial_state()) {
        taut::BodyOptions options;
        options.friction = double(touch.friction);
        options.thickness = double(touch.thickness);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            contacts_.add(Shape(bodies[k].a.template cast<Scalar>(),
                                bodies[k].b.template cast<Scalar>(), Scalar(bodies[k].radius)),
                          options, placed(at[k]));
        }
    }
    /// @returns whether the frame was not refused
    bool advance(const Places& to, const std::vector<PinAt>& pins = {}) {
        for (std::size_t k = 0; k < to.size(); ++k)
            contacts_.move_to(taut::Index(k), placed(to[k]));
        for (const PinAt& pin : pins) {
            state_.v.col(pin.particle) =
                (pin.x.template cast<Scalar>() - state_.x.col(pin.particle)) / Scalar(frame);
        }
        const auto report = guard_.advance(state_, Scalar(frame), seen_);
        ++frames_;
        refused_ += !report;
        again_ += report.again > 0;
        blind_ += report.blind;
        work_ += contacts_.work();
        substeps_ = report.substeps;
        return bool(report);
    }
    const taut::State<Scalar, 3>& state() const { return state_; }
    taut::Contacts<System>& contacts() { return contacts_; }
    SeenContacts<System>& seen() { return seen_; }
    int frames() const { return frames_; }
    int refused() const { return refused_; }
    int again() const { return again_; }
    int blind() const { return blind_; }
    double work() const { return work_; }  ///< of the bodies, J
    taut::Index substeps() const { return substeps_; }

private:
    static taut::Pose<Scalar, 3> placed(const Place& place) {
        return {place.position.template cast<Scalar>(), place.rotation.template cast<Scalar>()};
    }

    taut::Contacts<System> contacts_;
    SeenContacts<System> seen_{contacts_};
    taut::Guarded<taut::VelocityVerlet<System>> guard_;
    taut::State<Scalar, 3> state_;
    int frames_ = 0, refused_ = 0, again_ = 0, blind_ = 0;
    double work_ = 0;
    taut::Index substeps_ = 0;
};

}  // namespace bench
