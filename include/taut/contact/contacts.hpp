// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "../integrator/energy_stable_euler.hpp"
#include "../proof/energy_limit.hpp"
#include "detail/near.hpp"

namespace taut {

/// Convex bodies that move, and the particles of a SpringSystem that touch them, inside the step
/// [T39]: contact takes nothing off the certified step, however stiff it is, and the energy of a
/// scene rises by no more than the work of the bodies.
template <class System>
class Contacts final : public step_detail::StepWatch<typename System::Scalar, System::Dim> {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = Pose<Scalar, Dim>;

    explicit Contacts(const System& system) : system_(&system) {}
    explicit Contacts(const System&&) = delete;

    /// @param shape  HalfSpace, Sphere, Capsule, Box, in the body's frame
    /// @returns the body's index
    template <class Obstacle>
    Index add(Obstacle shape, const BodyOptions& options = {}, const Place& pose = {}) {
        require_obstacle<Obstacle, Vector>();
        using Body = contact_detail::BodyOf<Scalar, Dim, Obstacle>;
        bodies_.push_back(std::make_unique<Body>(std::move(shape), options, pose));
        near_.clear();
        return static_cast<Index>(bodies_.size()) - 1;
    }
    /// Where a body is at the end of the next frame; it is carried there rigidly.
    void move_to(Index body, const Place& pose) {
        bodies_[static_cast<std::size_t>(body)]->end = pose;
    }

    /// What the bodies did on the particles in the last frame, Σ h ū·f, J.
    double work() const { return sum(settled_.work); }
    /// What touching pairs hold at its end, J.
    double energy() const { return sum(settled_.energy); }
    /// Particles and bodies that touch, at the end of the last step.
    Index touching() const { return touching_.count; }
    /// m.
    Scalar deepest() const { return touching_.deepest; }
    /// How often what is near was looked up anew.
    Index lookups() const { return lookups_; }

    /// For steppers, before all else of a frame: looks whether the system was edited.
    void renew() {
        if (revision_ == system_->revision() + 1) return;
        revision_ = system_->revision() + 1;
        longest_ = energy_limit(*system_).certified;
        penalty_.by_mass = 100 / (longest_ * longest_);
        near_.clear();
        settled_.known.clear();
        settled_x_.resize(Dim, 0);
    }
    /// A frame of s, in steps of h, from `time`, all in s.
    void begin(Scalar frame, Scalar h, Scalar time) {
        renew();
        frame_ = frame;
        penalty_ = {h, 100 / (longest_ * longest_), 0};
        begun_ = time;
        work_.assign(system_->size() + step_detail::max_width, Scalar(0));
        fresh_ = true;
        drift_ = Vector::Zero();
        for (const auto& body : bodies_) {
            body->motion.go_to(body->begin);
            body->way = {body->begin, body->end};
            drift_ += (body->end.position - body->begin.position) /
                      (frame * static_cast<Scalar>(bodies_.size()));
        }
        // Far enough for some part of a frame in which bodies hurry, and a short list where not.
        Scalar most = 0;
        for (const auto& body : bodies_) most = (std::max)(most, body->far(frame * drift_));
        margin_ = (std::min)((std::max)(most / 8, Scalar(0.004)), Scalar(0.01));
    }
    /// What the last try of a frame came to: keeps it, as try 0 or 1.
    void end(int which) {
        Outcome& outcome = tries_[which];
        outcome.work.assign(system_->size(), 0);
        outcome.energy.assign(system_->size(), 0);
        for (Index place = 0; place < system_->size(); ++place)
            outcome.work[particle_[place]] = static_cast<double>(work_[place]);
        near_.remember(bodies_, outcome.known);
        for (const auto& body : bodies_) {
            const auto& solo = body->solo;
            for (Index k = 0; k < solo.blocks * Register::width; ++k) {
                if (!(solo.depth[k] > 0)) continue;
                outcome.energy[particle_[place_of(solo, k)]] +=
                    potential(solo.depth[k], solo.cap[k], solo.mass[k]);
            }
        }
        for (const auto& pair : near_.shared()) {
            outcome.energy[particle_[pair.place]] +=
                potential(pair.depth, pair.cap, mass_[pair.place]);
        }
    }
    /// The work on each particle in a try, J.
    const Buffer<double>& work_of(int which) const { return tries_[which].work; }
    /// What touching pairs of each particle hold at its end, J.
    const Buffer<double>& energy_of(int which) const { return tries_[which].energy; }
    /// Takes for each particle the try of that number.
    /// @param which  which(i), 0 or 1   @returns what touching pairs of each particle hold, J
    template <class Which>
    const Buffer<double>& choose(const Which& which) {
        settled_.work.resize(system_->size());
        settled_.energy.resize(system_->size());
        for (Index i = 0; i < system_->size(); ++i) {
            const Outcome& outcome = tries_[which(i)];
            settled_.work[i] = outcome.work[i];
            settled_.energy[i] = outcome.energy[i];
        }
        next_known_.clear();
        for (int each = 0; each < 2; ++each) {
            for (const auto& pair : tries_[each].known) {
                if (which(particle_[pair.place]) == each) next_known_.push_back(pair);
            }
        }
        std::sort(next_known_.begin(), next_known_.end());
        return settled_.energy;
    }
    /// The frame is over, and left this state.
    void settle(const taut::State<Scalar, Dim>& state) {
        settled_.known = next_known_;
        settled_x_ = state.x;
        for (const auto& body : bodies_) body->begin = body->end;
    }
    /// What touching pairs of each particle hold at a state, where bodies are now, J.
    const Buffer<double>& energy_at(const taut::State<Scalar, Dim>& state) {
        if (settled_x_.cols() == state.x.cols() && settled_x_ == state.x) return settled_.energy;
        settled_.energy.assign(system_->size(), 0);
        for (Index i = 0; i < system_->size(); ++i) {
            if (system_->is_pinned(i)) continue;
            for (const auto& body : bodies_) {
                Vector normal;
                const Scalar depth = body->depth(state.x.col(i), body->begin, normal);
                const Scalar cap = longest_ / 2 * static_cast<Scalar>(body->options.push_out);
                settled_.energy[i] += potential(depth, cap, system_->mass(i));
            }
        }
        settled_.known.clear();
        settled_x_ = state.x;
        return settled_.energy;
    }

    void see(const step_detail::PlaceVectors<Scalar, Dim>&,
             const step_detail::PlaceVectors<Scalar, Dim>&, Scalar, const taut::State<Scalar, Dim>*,
             const Points<Scalar, Dim>*) override {}
    void before(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                const step_detail::StateMemory<Scalar>& memory, Scalar time) override {
        if (!std::exchange(fresh_, false)) return;
        mass_.assign(layout.size() + step_detail::max_width, 0);
        particle_.resize(layout.size());
        for (Index i = 0; i < layout.size(); ++i) {
            particle_[places[i]] = static_cast<int>(i);
            if (!system_->is_pinned(i)) mass_[places[i]] = system_->mass(i);
        }
        const Access x(layout, memory.planes().x);
        known_ = settled_.known;
        look_up(x, layout.size(), time, margin_);
    }
    bool passed(const step_detail::Layout<Scalar>& layout, const Buffer<int>&,
                step_detail::StateMemory<Scalar>& memory, Scalar time, Scalar ahead) override {
        const auto& planes = memory.planes();
        const Index count = layout.size();
        const contact_detail::Moving<Scalar, Dim> moving{
            {layout, planes.x}, {layout, planes.v}, {layout, planes.spring_x}};
        penalty_.ahead = ahead;
        const Scalar share = (std::min)((time - begun_) / frame_, Scalar(1));
        for (const auto& body : bodies_) {
            body->motion.go_to(body->way(share));
        }
        near_.go_to(bodies_, time);
        bool known = near_.holds(moving.x, count);
        for (Scalar margin = margin_;; margin *= 4) {
            if (!known) {
                look_back(layout, planes, time, margin);
                near_.go_to(bodies_, time);
                known = near_.holds(moving.x, count);
                if (!known) continue;
            }
            touch(moving);
            if (pushed_in_reach(moving.x)) break;
            undo(moving);
            known = false;
        }
        for (const auto& body : bodies_) {
            const auto& hits = body->hits;
            for (Index k = 0; k < hits.count; ++k) {
                Scalar* work = work_.data() + body->solo.first[hits.block[k]];
                (Register::load(work) + Register::load(hits.work.data() + k * Register::width))
                    .store(work);
            }
        }
        for (const auto& touched : touched_)
            work_[touched.place] += static_cast<Scalar>(touched.work);
        return true;
    }

    void kicked(const step_detail::Layout<Scalar>& layout,
                step_detail::StateMemory<Scalar>& memory) override {
        const Access v(layout, memory.planes().v);
        const auto stop = [&](int place, const contact_detail::Body<Scalar, Dim>& body,
                              const Vector& x, const Vector& normal) {
            const auto& motion = body.motion;  // which ends here
            const Vector u = (x - motion.now(motion.next.inside(x))) / penalty_.h;
            const Vector before = v.vector(place), w = before - u;
            const Scalar into = -normal.dot(w);
            if (!(into > 0)) return;
            const Vector along = w + into * normal;
            const Scalar sliding = along.norm();
            const auto friction = static_cast<Scalar>(body.options.friction);
            const Scalar keep =
                sliding > friction * into ? 1 - friction * into / sliding : Scalar(0);
            const Vector after = u + (friction > 0 ? Vector(keep * along) : along);
            v.set(place, after);
            work_[place] += mass_[place] * u.dot(after - before);
        };
        for (const auto& body : bodies_) {
            const auto& solo = body->solo;
            for (Index k = 0; k < solo.blocks * Register::width; ++k) {
                if (!(solo.depth[k] > 0)) continue;
                Vector x, normal;
                for (int d = 0; d < Dim; ++d) {
                    x[d] = solo.x[d][k];
                    normal[d] = solo.normal[d][k];
                }
                stop(place_of(solo, k), *body, x, normal);
            }
        }
        for (const auto& pair : near_.shared()) {
            if (!(pair.depth > 0)) continue;
            stop(pair.place, *bodies_[static_cast<std::size_t>(pair.body)], pair.x, pair.normal);
        }
    }

private:
    using Access = contact_detail::PlaneAccess<Scalar, Dim>;
    using Register = step_detail::VectorRegister<Scalar>;
    /// A particle of shared pairs that was touched: what it was without, and what that did.
    struct Touched {
        int place;
        Vector x, v;  // m, m/s
        double work;  // J
        std::pair<std::size_t, std::size_t> pairs;
    };

    /// Lists what is near where the step began.
    void look_back(const step_detail::Layout<Scalar>& layout,
                   const step_detail::StatePlanes<Scalar>& planes, Scalar time, Scalar margin) {
        const Index size = layout.planes() * layout.stride();
        old_.resize(size);
        for (Index i = 0; i < size; ++i)
            old_[i] = planes.x.first[i] - penalty_.h * planes.v.first[i];
        near_.remember(bodies_, known_);
        for (const auto& body : bodies_) std::swap(body->motion.now, body->motion.next);
        look_up(Access(layout, {old_.data(), planes.x.stride}), layout.size(), time - penalty_.h,
                margin);
        for (const auto& body : bodies_) std::swap(body->motion.now, body->motion.next);
    }
    /// Whether those that were touched have met no body that does not list them.
    bool pushed_in_reach(const Access& x) const {
        const Register zero(Scalar(0)), below(Scalar(-1));
        for (const auto& body : bodies_) {
            const auto& hits = body->hits;
            Register worst = below;
            for (Index k = 0; k < hits.count; ++k) {
                const Register touched = Register::load(hits.touched.data() + k * Register::width);
                const Index place = body->solo.first[hits.block[k]];
                const Register beyond = near_.beyond(x, place);
                worst = larger(worst, where_less(zero, touched, beyond, below));
            }
            if (!(contact_detail::largest_lane(worst) < 0)) return false;
        }
        for (const auto& touched : touched_) {
            if (!near_.holds_of(x, touched.place)) return false;
        }
        return true;
    }
    /// Contact of all pairs in a step.
    void touch(const contact_detail::Moving<Scalar, Dim>& moving) {
        touching_ = {};
        touched_.clear();
        old_pairs_.clear();
        for (const auto& body : bodies_) body->step(penalty_, moving, touching_);
        auto& shared = near_.shared();
        for (std::size_t first = 0, end; first < shared.size(); first = end) {
            const int place = shared[first].place;
            for (end = first; end < shared.size() && shared[end].place == place;) ++end;
            if (near_.away(moving.x, &shared[first], end - first)) {
                shared[first].old = true;
                continue;
            }
            Touched touched{place, moving.x.vector(place), moving.v.vector(place), 0, {}};
            Vector x = touched.x, v = touched.v;
            if (std::exchange(shared[first].old, false)) {
                for (std::size_t k = first; k < end; ++k) {
                    auto& pair = shared[k];
                    const auto& body = *bodies_[static_cast<std::size_t>(pair.body)];
                    pair.x = x - penalty_.h * v;
                    pair.depth = body.depth(pair.x, body.motion.now, pair.normal);
                }
            }
            Scalar work = 0;
            const bool touches = solve_(bodies_, &shared[first], end - first, penalty_, x, v, work);
            if (touches) {
                moving.x.set(place, x);
                moving.v.set(place, v);
                if (penalty_.ahead > 0) moving.spring_x.set(place, x + penalty_.ahead * v);
                touched.work = static_cast<double>(work) * static_cast<double>(mass_[place]);
                touched.pairs = {first, end};
                for (std::size_t k = first; k < end; ++k) old_pairs_.push_back(shared[k]);
                touched_.push_back(touched);
            }
            for (std::size_t k = first; k < end; ++k) {
                auto& pair = shared[k];
                const auto& body = *bodies_[static_cast<std::size_t>(pair.body)];
                pair.x = x;
                pair.depth = body.depth(x, body.motion.next, pair.normal);
                if (!(pair.depth > 0)) pair.cap = std::numeric_limits<Scalar>::infinity();
                touching_.see(pair.depth);
            }
        }
    }
    /// A step without contact again, its lists as they were.
    void undo(const contact_detail::Moving<Scalar, Dim>& moving) {
        const auto set = [&](int place, const Vector& x, const Vector& v) {
            moving.x.set(place, x);
            moving.v.set(place, v);
            if (penalty_.ahead > 0) moving.spring_x.set(place, x + penalty_.ahead * v);
        };
        for (const auto& body : bodies_) {
            const auto& hits = body->hits;
            for (Index k = 0; k < hits.count; ++k) {
                const Index from = k * Register::width, to = hits.block[k] * Register::width;
                const Index place = body->solo.first[hits.block[k]];
                for (int d = 0; d < Dim; ++d) {
                    const Register x = Register::load(hits.x[d].data() + from);
                    const Register v = Register::load(hits.v[d].data() + from);
                    moving.x.set_row(d, place, x);
                    moving.v.set_row(d, place, v);
                    if (penalty_.ahead > 0)
                        moving.spring_x.set_row(d, place, x + Register(penalty_.ahead) * v);
                }
                Register::load(hits.depth.data() + from).store(body->solo.depth.data() + to);
                Register::load(hits.cap.data() + from).store(body->solo.cap.data() + to);
            }
        }
        auto old = old_pairs_.begin();
        for (const auto& touched : touched_) {
            set(touched.place, touched.x, touched.v);
            for (std::size_t k = touched.pairs.first; k < touched.pairs.second; ++k)
                near_.shared()[k] = *old++;
        }
    }
    void look_up(const Access& x, Index count, Scalar time, Scalar margin) {
        ++lookups_;
        near_.build(bodies_, known_, mass_, x, count, margin, longest_ / 2, drift_, time);
    }
    static int place_of(const contact_detail::SoloPairs<Scalar, Dim>& solo, Index k) {
        return solo.first[k / Register::width] + static_cast<int>(k % Register::width);
    }
    static double sum(const Buffer<double>& of) {
        double sum = 0;
        for (const double each : of) sum += each;
        return sum;
    }
    double potential(Scalar depth, Scalar cap, Scalar mass) const {
        if (!(depth > 0)) return 0;
        const double k = static_cast<double>(penalty_.by_mass) * static_cast<double>(mass);
        const auto p = static_cast<double>(depth), most = static_cast<double>(cap);
        return p <= most ? k * p * p / 2 : k * most * (p - most / 2);
    }

    const System* system_;
    std::uint64_t revision_ = 0;    // of what longest_ belongs to, and one
    Scalar longest_ = 0;            // step of energy_limit, s
    Scalar margin_ = 0;             // m, of the frame
    Scalar frame_ = 0, begun_ = 0;  // s
    contact_detail::Penalty<Scalar> penalty_{};
    Vector drift_ = Vector::Zero();
    bool fresh_ = false;
    std::vector<std::unique_ptr<contact_detail::Body<Scalar, Dim>>> bodies_;
    contact_detail::NearList<Scalar, Dim> near_;
    contact_detail::ParticleSolve<Scalar, Dim> solve_;
    Buffer<Scalar> mass_;   // by place, kg; 0 if pinned
    Buffer<Scalar> work_;   // by place, J
    Buffer<int> particle_;  // at each place
    std::vector<contact_detail::KnownPair> known_;
    std::vector<contact_detail::KnownPair> next_known_;
    struct Outcome {
        Buffer<double> work, energy;  // of each particle, J
        std::vector<contact_detail::KnownPair> known;
    };
    detail::Few<Outcome, 2> tries_;
    Outcome settled_;
    Points<Scalar, Dim> settled_x_;  // m
    Buffer<Scalar> old_;             // planes, m
    contact_detail::Touching<Scalar> touching_;
    std::vector<Touched> touched_;  // of shared pairs
    std::vector<contact_detail::SharedPair<Scalar, Dim>> old_pairs_;
    Index lookups_ = 0;
};

/// Takes `count` steps of h, s, one frame for the bodies.
template <class System, class AnyState>
Report step_through(EnergyStableEuler<System>& stepper, AnyState& state, typename System::Scalar h,
                    Index count, Contacts<System>& contacts) {
    using Scalar = typename System::Scalar;
    contacts.begin(h * static_cast<Scalar>(count), h, static_cast<Scalar>(state.time));
    const struct Watching {
        EnergyStableEuler<System>& stepper;
        ~Watching() { stepper.watch(nullptr); }
    } watching{stepper};
    stepper.watch(&contacts);
    const Report report = stepper.step(state, h, count);
    if (!report) return report;
    contacts.end(0);
    contacts.choose([](Index) { return 0; });
    contacts.settle(state);
    return report;
}

}  // namespace taut
