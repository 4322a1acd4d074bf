// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/proof/bracket.hpp>

#include "laws.hpp"
#include "scene.hpp"

// What is behind Scene, for the few files that name a system: scene_*.cpp, and a module's own,
// which makes its steppers for scenes.

namespace taut_test {

class Scene::Base {
public:
    virtual ~Base() = default;
    virtual std::unique_ptr<Base> copy() const = 0;
    virtual Index add_particle(const Eigen::VectorXd& x, double mass) = 0;
    virtual Index add_spring(const AnySpring& spring) = 0;
    virtual void remove_spring(LawOf law, Index s) = 0;
    virtual void set_pinned(Index i, bool pinned) = 0;
    virtual void set_mass(Index i, double mass) = 0;
    virtual void set_gravity(const Eigen::VectorXd& g) = 0;
    virtual void set_rayleigh(const taut::RayleighDamping& rayleigh) = 0;
    virtual void set_constant_force(Index i, const Eigen::VectorXd& force) = 0;
    virtual void set_external_force(
        std::function<void(const AnyState&, Eigen::MatrixXd&)> force) = 0;
    virtual Index size() const = 0;
    virtual Index spring_count() const = 0;
    virtual bool is_pinned(Index i) const = 0;
    virtual double mass(Index i) const = 0;
    virtual Eigen::VectorXd gravity() const = 0;
    virtual taut::RayleighDamping rayleigh() const = 0;
    virtual std::uint64_t revision() const = 0;
    virtual std::vector<AnySpring> springs() const = 0;
    virtual AnyState initial_state() const = 0;
    virtual Eigen::MatrixXd force(const AnyState& state, double ahead) const = 0;
    virtual double kinetic_energy(const AnyState& state) const = 0;
    virtual double potential_energy(const AnyState& state) const = 0;
    virtual double energy(const AnyState& state) const = 0;
    virtual taut::StepLimit<double> any_pose_limit() const = 0;
    virtual taut::StepLimit<double> energy_limit() const = 0;
    virtual taut::StepLimit<double> limit(taut::Method method, const AnyState& state) const = 0;
    virtual std::unique_ptr<AnyStepper> stepper(taut::Method method, int threads) const = 0;
};

template <class State>
State from_any(const AnyState& any) {
    using Scalar = typename State::Scalar;
    State state;
    state.x = any.x.template cast<Scalar>();
    state.v = any.v.template cast<Scalar>();
    state.time = static_cast<Scalar>(any.time);
    return state;
}

template <class State>
AnyState to_any(const State& state) {
    return {state.x.template cast<double>(), state.v.template cast<double>(),
            static_cast<double>(state.time)};
}

/// A stepper behind AnyStepper, or behind a Base of it that has more.
template <class Stepper, class System, class Base = AnyStepper>
class StepperOn : public Base {
public:
    template <class... More>
    explicit StepperOn(const System& system, const More&... more) : stepper_(system, more...) {}

    taut::Report step(AnyState& any, double h, Index count) override {
        auto state = from_any<typename System::State>(any);
        const taut::Report report =
            stepper_.step(state, static_cast<typename System::Scalar>(h), count);
        any = to_any(state);
        return report;
    }
    Stepper& stepper() { return stepper_; }

protected:
    Stepper stepper_;
};

template <class Scalar>
void set_second(taut::Hookean::Parameters<Scalar>&, const AnySpring&) {}
template <class Scalar>
void set_second(Buckling::Parameters<Scalar>& p, const AnySpring& spring) {
    p.bending = static_cast<Scalar>(spring.second);
    p.onset = static_cast<Scalar>(spring.third);
}
template <class Scalar>
void set_second(Glue::Parameters<Scalar>& p, const AnySpring& spring) {
    p.width = static_cast<Scalar>(spring.second);
}
template <class Scalar>
void get_second(const taut::Hookean::Parameters<Scalar>&, AnySpring&) {}
template <class Scalar>
void get_second(const Buckling::Parameters<Scalar>& p, AnySpring& spring) {
    spring.second = static_cast<double>(p.bending);
    spring.third = static_cast<double>(p.onset);
}
template <class Scalar>
void get_second(const Glue::Parameters<Scalar>& p, AnySpring& spring) {
    spring.second = static_cast<double>(p.width);
}

constexpr LawOf law_of(taut::Hookean) { return LawOf::hookean; }
constexpr LawOf law_of(TensionOnly) { return LawOf::tension_only; }
constexpr LawOf law_of(Buckling) { return LawOf::buckling; }
constexpr LawOf law_of(Glue) { return LawOf::glue; }

template <class Law>
typename Law::template Parameters<long double> exact_parameters(const AnySpring& spring) {
    typename Law::template Parameters<long double> p{};
    p.stiffness = spring.stiffness;
    set_second(p, spring);
    return p;
}

template <class System_>
class SceneOn : public Scene::Base {
public:
    using System = System_;
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;

    System system;

    std::unique_ptr<Base> copy() const override { return std::make_unique<SceneOn>(*this); }
    Index add_particle(const Eigen::VectorXd& x, double mass) override {
        return system.add_particle(x.cast<Scalar>(), static_cast<Scalar>(mass));
    }
    Index add_spring(const AnySpring& spring) override {
        Index added = -1;
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            if (law_of(Law{}) != spring.law) return;
            typename Law::template Parameters<Scalar> p{};
            p.stiffness = static_cast<Scalar>(spring.stiffness);
            set_second(p, spring);
            added = system.add_spring(taut::Spring<Scalar, Law>{
                spring.a, spring.b, p, static_cast<Scalar>(spring.rest_length),
                static_cast<Scalar>(spring.damping)});
        });
        if (added < 0) throw std::logic_error("the scene's system has no such law");
        return added;
    }
    void remove_spring(LawOf law, Index s) override {
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            if (law_of(Law{}) == law) system.template remove_spring<Law>(s);
        });
    }
    void set_pinned(Index i, bool pinned) override { pinned ? system.pin(i) : system.unpin(i); }
    void set_mass(Index i, double mass) override { system.set_mass(i, static_cast<Scalar>(mass)); }
    void set_gravity(const Eigen::VectorXd& g) override { system.set_gravity(g.cast<Scalar>()); }
    void set_rayleigh(const taut::RayleighDamping& rayleigh) override {
        system.set_rayleigh(rayleigh);
    }
    void set_constant_force(Index i, const Eigen::VectorXd& force) override {
        system.set_constant_force(i, force.cast<Scalar>());
    }
    void set_external_force(std::function<void(const AnyState&, Eigen::MatrixXd&)> force) override {
        if (!force) return system.set_external_force({});
        system.set_external_force([force](const State& state, typename System::Force& f) {
            Eigen::MatrixXd sum = f.template cast<double>();
            force(to_any(state), sum);
            f = sum.cast<Scalar>();
        });
    }
    Index size() const override { return system.size(); }
    Index spring_count() const override { return system.spring_count(); }
    bool is_pinned(Index i) const override { return system.is_pinned(i); }
    double mass(Index i) const override { return static_cast<double>(system.mass(i)); }
    Eigen::VectorXd gravity() const override { return system.gravity().template cast<double>(); }
    taut::RayleighDamping rayleigh() const override { return system.rayleigh(); }
    std::uint64_t revision() const override { return system.revision(); }
    std::vector<AnySpring> springs() const override {
        std::vector<AnySpring> all;
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                AnySpring spring{set.a[s],
                                 set.b[s],
                                 static_cast<double>(set.parameters[s].stiffness),
                                 static_cast<double>(set.rest_length[s]),
                                 static_cast<double>(set.damping_of(s)),
                                 law_of(Law{})};
                get_second(set.parameters[s], spring);
                all.push_back(spring);
            }
        });
        return all;
    }
    AnyState initial_state() const override { return to_any(system.initial_state()); }
    Eigen::MatrixXd force(const AnyState& any, double ahead) const override {
        const auto state = from_any<State>(any);
        typename System::Force f;
        if (ahead > 0) {
            system.force_ahead(state, static_cast<Scalar>(ahead), f);
        } else {
            system.force(state, f);
        }
        return f.template cast<double>();
    }
    double kinetic_energy(const AnyState& state) const override {
        return static_cast<double>(system.kinetic_energy(from_any<State>(state)));
    }
    double potential_energy(const AnyState& state) const override {
        return static_cast<double>(system.potential_energy(from_any<State>(state)));
    }
    double energy(const AnyState& state) const override {
        return static_cast<double>(system.energy(from_any<State>(state)));
    }
    taut::StepLimit<double> any_pose_limit() const override {
        return to_any(taut::any_pose_bracket(system));
    }
    taut::StepLimit<double> energy_limit() const override {
        return to_any(taut::energy_bracket(system));
    }
    taut::StepLimit<double> limit(taut::Method method, const AnyState& state) const override {
        return to_any(
            taut::bracket(taut::Stability<Scalar>(system, from_any<State>(state)), method));
    }
    std::unique_ptr<AnyStepper> stepper(taut::Method method, int threads) const override {
        const taut::ExplicitOptions options{threads};
        switch (method) {
            case taut::Method::energy_stable_euler:
                return make<taut::EnergyStableEuler<System>>(options);
            case taut::Method::velocity_verlet: return make<taut::VelocityVerlet<System>>(options);
            default: break;
        }
        if constexpr (!std::is_same_v<System, AnyLaw<Scalar, Dim>>) {
            switch (method) {
                case taut::Method::explicit_euler:
                    return make<taut::ExplicitEuler<System>>(options);
                case taut::Method::symplectic_euler:
                    return make<taut::SymplecticEuler<System>>(options);
                case taut::Method::implicit_euler: return make<taut::ImplicitEuler<System>>();
                default: break;
            }
        }
        throw std::logic_error("no such stepper for this scene");
    }
    template <class Stepper, class... More>
    std::unique_ptr<AnyStepper> make(const More&... more) const {
        return std::make_unique<StepperOn<Stepper, System>>(system, more...);
    }
};

/// visit(system) if the scene's system is one of those named; else it throws.
template <class... Systems, class Visit>
void visit_system(const Scene& scene, Visit&& visit) {
    bool found = false;
    const auto try_one = [&](auto* of) {
        if (auto* typed = dynamic_cast<std::decay_t<decltype(*of)>*>(&scene.base())) {
            visit(typed->system);
            found = true;
        }
    };
    (try_one(static_cast<SceneOn<Systems>*>(nullptr)), ...);
    if (!found) throw std::logic_error("no " + scene.kind().text() + " among the systems");
}

template <class Scalar, int Dim>
using Plain = taut::SpringSystem<Scalar, Dim>;

/// visit(system) of whatever scene.
template <class Visit>
void visit_any_system(const Scene& scene, Visit&& visit) {
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<float, 3>, Plain<double, 1>,
                 Plain<double, 2>, Plain<double, 3>, Strings<float, 2>, Strings<float, 3>,
                 Strings<double, 2>, Strings<double, 3>, Mixed<float, 2>, Mixed<float, 3>,
                 Mixed<double, 2>, Mixed<double, 3>, AnyLaw<double, 1>, AnyLaw<double, 2>,
                 AnyLaw<double, 3>, AnyLaw<float, 3>>(scene, visit);
}

/// A module's stepper for a scene whose system is one of those named.
template <template <class...> class Stepper, class... Systems, class... More>
std::unique_ptr<AnyStepper> make_stepper(const Scene& scene, const More&... more) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Systems...>(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        made = std::make_unique<StepperOn<Stepper<System>, System>>(system, more...);
    });
    return made;
}

/// Steps the scene linearised at its initial state, by Stepper of LinearSystem.
template <class Stepper, class System>
class LinearOn : public AnyStepper {
public:
    explicit LinearOn(const System& system)
        : linear_(taut::linearize(system, system.initial_state())), stepper_(linear_) {}

    taut::Report step(AnyState& any, double h, Index count) override {
        auto state = from_any<typename System::State>(any);
        auto u = linear_.to_free(state);
        const auto report = stepper_.step(u, static_cast<typename System::Scalar>(h), count);
        linear_.from_free(u, state);
        state.time = u.time;
        any = to_any(state);
        return report;
    }

private:
    taut::LinearSystem<typename System::Scalar> linear_;
    Stepper stepper_;
};

// One of scene_*.cpp instantiates each.
#define TAUT_TEST_SCENES(KIND, SCALAR)                 \
    KIND class SceneOn<taut::SpringSystem<SCALAR, 1>>; \
    KIND class SceneOn<taut::SpringSystem<SCALAR, 2>>; \
    KIND class SceneOn<taut::SpringSystem<SCALAR, 3>>; \
    KIND class SceneOn<Strings<SCALAR, 2>>;            \
    KIND class SceneOn<Strings<SCALAR, 3>>;            \
    KIND class SceneOn<Mixed<SCALAR, 2>>;              \
    KIND class SceneOn<Mixed<SCALAR, 3>>;
TAUT_TEST_SCENES(extern template, float)
TAUT_TEST_SCENES(extern template, double)
}  // namespace taut_test

// With the steppers of these scenes, which Taut::Compiled does not hold.
#define TAUT_TEST_ANY_STEPPER(KIND, SCALAR, DIM, STEPPER)                  \
    KIND class taut::STEPPER<taut_test::AnyLaw<SCALAR, DIM>>;              \
    KIND taut::Report taut::STEPPER<taut_test::AnyLaw<SCALAR, DIM>>::step( \
        taut::State<SCALAR, DIM>&, SCALAR, taut::Index);
#define TAUT_TEST_ANY_SCENE(KIND, SCALAR, DIM)                  \
    TAUT_TEST_ANY_STEPPER(KIND, SCALAR, DIM, VelocityVerlet)    \
    TAUT_TEST_ANY_STEPPER(KIND, SCALAR, DIM, EnergyStableEuler) \
    KIND class taut_test::SceneOn<taut_test::AnyLaw<SCALAR, DIM>>;
TAUT_TEST_ANY_SCENE(extern template, double, 1)
TAUT_TEST_ANY_SCENE(extern template, double, 2)
TAUT_TEST_ANY_SCENE(extern template, double, 3)
TAUT_TEST_ANY_SCENE(extern template, float, 3)
