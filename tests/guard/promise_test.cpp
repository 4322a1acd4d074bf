// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What Guard promises, by trying to break it.
#include <cmath>
#include <limits>
#include <taut/guard/guard.hpp>

#include "../support/catch.hpp"
#include "../support/guard_audit.hpp"
#include "../support/laws.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guard_promise_test {

using taut::Guard;

namespace {

/// Nets or chains in two parts of unlike mass, some springs slack, some turned inside out.
template <class System>
System nets(Random& random, bool damped) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    System system;
    const Index size = 3 + random.below(3);
    const Index width = random.below(2) == 0 ? 1 : size;  // chains
    const double spread = random.below(3) == 0 ? 1e6 : 4;
    for (int part = 0; part < 2; ++part) {
        const Index first = system.size();
        const double mass = log_uniform(random, 1 / spread, spread);
        const double k = log_uniform(random, 10, 1e4);
        for (Index i = 0; i < size * width; ++i) {
            typename System::Vector x = random.vector<Scalar, Dim>(-0.02, 0.02);
            x[0] += static_cast<Scalar>(0.1 * static_cast<double>(i % size));
            if (Dim > 1) x[1] += static_cast<Scalar>(0.1 * static_cast<double>(i / size));
            system.add_particle(x, static_cast<Scalar>(mass * log_uniform(random, 0.5, 2)));
        }
        const auto join = [&](Index a, Index b) {
            const Scalar L = static_cast<Scalar>(random.uniform(0.06, 0.12));
            const Scalar c = damped ? static_cast<Scalar>(mass * random.uniform(0, 5)) : Scalar(0);
            using Law = typename System::FirstLaw;
            system.add_spring(
                taut::Spring<Scalar, Law>{first + a, first + b, {static_cast<Scalar>(k)}, L, c});
        };
        for (Index i = 0; i < size * width; ++i) {
            if (i % size + 1 < size) join(i, i + 1);
            if (i + size < size * width) join(i, i + size);
            if (i % size + 1 < size && i + size + 1 < size * width) join(i, i + size + 1);
        }
    }
    system.set_gravity(random.vector<Scalar, Dim>(-10, 10));
    if (damped) system.set_rayleigh({random.uniform(0, 3), random.uniform(0, 1e-3)});
    if (random.below(3) > 0) system.pin(0);
    if (random.below(3) == 0) system.pin(system.size() - 1);
    return system;
}

template <class System>
typename System::State thrown(Random& random, const System& system, double away) {
    using Scalar = typename System::Scalar;
    auto state = system.initial_state();
    const double speed = random.below(4) == 0 ? 0 : log_uniform(random, 0.1, 100);
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i))
            state.v.col(i) = random.vector<Scalar, System::Dim>(-speed, speed);
    }
    state.x.array() += static_cast<Scalar>(away);
    return state;
}

/// Velocities of pins for the next frame: jerked now and then.
template <class System>
void drive(Random& random, const System& system, typename System::State& state) {
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) continue;
        const double speed = random.below(3) == 0 ? log_uniform(random, 0.01, 30) : 0;
        state.v.col(i) = random.vector<typename System::Scalar, System::Dim>(-speed, speed);
    }
}

/// Tears, joins, pins, frees, stiffens, teleports.
template <class System>
void edit(Random& random, System& system, typename System::State& state) {
    using Scalar = typename System::Scalar;
    using Law = typename System::FirstLaw;
    const Index i = random.below(system.size());
    const Index j = (i + 1 + random.below(system.size() - 1)) % system.size();
    const Index springs = system.template springs<Law>().size();
    switch (random.below(8)) {
        case 0:
        case 1:
            if (springs > 0) system.template remove_spring<Law>(random.below(springs));
            break;
        case 2:
            system.add_spring(taut::Spring<Scalar, Law>{
                i, j, {static_cast<Scalar>(log_uniform(random, 1, 1e3))}, Scalar(0.1)});
            break;
        case 3: system.pin(i); break;
        case 4: system.unpin(i); break;
        case 5: {
            const double factor = random.below(2) == 0 ? 1e6 : 1e-6;
            if (springs == 0) break;
            const Index s = random.below(springs);
            const auto k = static_cast<double>(
                system.template springs<Law>().parameters[static_cast<std::size_t>(s)].stiffness);
            system.template set_parameters<Law>(
                s, {static_cast<Scalar>(std::min(1e6, std::max(1e-3, k * factor)))});
            break;
        }
        case 6:
            state.x.col(i) += random.vector<Scalar, System::Dim>(-1, 1);
            state.v.col(i) = random.vector<Scalar, System::Dim>(-10, 10);
            break;
        default: system.set_mass(i, static_cast<Scalar>(log_uniform(random, 1e-3, 1e3)));
    }
}

struct Count {
    Index frames = 0, refused = 0, broken = 0, trimmed = 0, again = 0;
};

/// @param garbage  makes a trial's end of the state: garbage(random, state), or nothing
template <class System, class Make>
void attack(std::uint32_t seed, Count& count, const Make& make, bool edits) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    const bool damped = random.below(2) == 0;
    System system = nets<System>(random, damped);
    const double away = random.below(2) == 0 ? 0 : log_uniform(random, 1, 100);
    auto state = thrown(random, system, away);
    auto guard = make(system, random);
    Audit<System> audit(system, state);
    const double span = random.below(5) == 0 ? 0.1 : 1.0 / 60;
    for (int i = 0; i < 40; ++i) {
        drive(random, system, state);
        if (edits && random.below(4) == 0) edit(random, system, state);
        audit.edited(state);
        const auto report = guard.advance(state, static_cast<Scalar>(span));
        ++count.frames;
        count.refused += !report;
        if (!report) continue;
        REQUIRE(state.finite());
        const double broken = audit.frame(state, guard, report);
        if (broken > 0) {
            CAPTURE(seed, i, broken, edits, damped, report.again, report.trimmed);
            CHECK(broken <= 0);
        }
        count.broken += broken > 0;
        count.trimmed += report.trimmed;
        count.again += report.again;
    }
}

/// Velocity Verlet, and after it what `Kind` says.
template <class System>
class Garbage {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr taut::Method method = taut::Method::velocity_verlet;

    Garbage(const System& system, Random& random, int kind)
        : system_(&system), stepper_(system), random_(&random), kind_(kind) {}
    taut::Report step(State& state, Scalar h, Index count = 1) {
        const auto report = stepper_.step(state, h, count);
        const Index i = random_->below(system_->size());
        const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
        const Scalar huge = std::numeric_limits<Scalar>::max();
        if (kind_ == 0) state.x(0, i) = nan;
        if (kind_ == 1) state.v *= Scalar(-2);
        if (kind_ == 2) state.x.col(i).array() += Scalar(0.3);
        if (kind_ == 3) state.x.setConstant(huge);
        if (kind_ == 4) state.v.setConstant(std::sqrt(huge));
        if (kind_ == 5) state.x.resize(System::Dim, 1);
        if (kind_ == 6) state.time = nan;
        if (kind_ == 7) return {taut::Status::solver_failed};
        return report;
    }

private:
    const System* system_;
    taut::VelocityVerlet<System> stepper_;
    Random* random_;
    int kind_;
};

}  // namespace

TEMPLATE_TEST_CASE(
    "guard: the promise holds for thrown, driven and edited scenes, and no frame is "
    "refused",
    "[guard]", (Case<float, 1>), (Case<float, 2>), (Case<double, 1>), (Case<double, 2>),
    (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    using Springs = Mixed<Scalar, TestType::Dim>;
    using Slack = Strings<Scalar, TestType::Dim>;
    Count count;
    const auto make = [](const auto& system, Random&) { return taut::Guard(system); };
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        attack<Springs>(seed, count, make, seed % 2 == 0);
        attack<Slack>(seed, count, make, seed % 2 == 0);
    }
    CHECK(count.refused == 0);
    CHECK(count.broken == 0);
    CHECK(count.trimmed > 0);
    CHECK(count.again > 0);
    CHECK(count.again < count.frames / 5);
    UNSCOPED_INFO(count.trimmed << " trimmed, " << count.again << " again");
}

TEMPLATE_TEST_CASE("guard: the promise holds whatever a trial does", "[guard]", (Case<float, 3>),
                   (Case<double, 2>)) {
    using Scalar = typename TestType::Scalar;
    using System = Strings<Scalar, TestType::Dim>;
    for (int kind = 0; kind < 8; ++kind) {
        CAPTURE(kind);
        Count count;
        const auto make = [&](const System& system, Random& random) {
            return taut::Guard<Garbage<System>>(system, {}, random, kind);
        };
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
            attack<System>(seed, count, make, seed % 2 == 0);
        }
        CHECK(count.refused == 0);
        CHECK(count.broken == 0);
        CHECK(count.again > 0);
    }
}

TEST_CASE("guard: masses over twelve decades", "[guard]") {
    using System = taut::SpringSystem<double, 2, TensionOnly>;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        System system;
        for (int i = 0; i < 6; ++i) {
            system.add_particle({0.1 * i, 0}, log_uniform(random, 1e-6, 1e6));
            if (i > 0) system.add_spring(taut::Spring<double, TensionOnly>{i - 1, i, {100}, 0.1});
        }
        system.set_gravity({0, -10});
        auto state = thrown(random, system, 0);
        taut::Guard guard(system);
        Audit<System> audit(system, state);
        for (int i = 0; i < 20; ++i) {
            const auto report = guard.advance(state, 1.0 / 60);
            REQUIRE(report);
            CHECK(audit.frame(state, guard, report) <= 0);
        }
    }
}

}  // namespace taut_test::guard_promise_test
