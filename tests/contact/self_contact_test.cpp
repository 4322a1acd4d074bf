// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/contact/self_contact.hpp>
#include <taut/guard/guard.hpp>

#include "../support/catch.hpp"
#include "../support/energy_steps.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::self_contact_test {

namespace {

/// Every pair of balls, one by one: what SelfContact finds by a hash and a list.
template <class System>
struct AllPairs {
    using State = typename System::State;
    static constexpr int Dim = System::Dim;

    const System& system;
    taut::SelfContact<System>& contact;
    std::vector<std::vector<bool>> joined;

    AllPairs(const System& of, taut::SelfContact<System>& balls) : system(of), contact(balls) {
        const auto count = static_cast<std::size_t>(of.size());
        joined.assign(count, std::vector<bool>(count, false));
        of.for_each_spring([&](Index a, Index b) {
            joined[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = true;
            joined[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)] = true;
        });
    }
    /// visit(a, b, κ, R)
    template <class Visitor>
    void for_each(Visitor&& visit) const {
        for (Index a = 0; a < system.size(); ++a) {
            for (Index b = a + 1; b < system.size(); ++b) {
                if (joined[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]) continue;
                if (system.is_pinned(a) && system.is_pinned(b)) continue;
                visit(a, b, static_cast<Real>(contact.stiffness(a, b)),
                      static_cast<Real>(contact.radius(a) + contact.radius(b)));
            }
        }
    }
    Real energy(const State& state) const {
        Real sum = 0;
        for_each([&](Index a, Index b, Real k, Real R) {
            const auto r =
                (state.x.col(b).template cast<Real>() - state.x.col(a).template cast<Real>())
                    .eval();
            const Real deep = R - r.norm();
            if (deep > 0) sum += k * deep * deep / 2;
        });
        return sum;
    }
    /// What rounding errors of a step's energy are relative to, J.
    Real size(const State& before, const State& after) const {
        Real sum = 0;
        for_each([&](Index a, Index b, Real k, Real R) {
            const auto reach = [&](const State& s, Index i) {
                return static_cast<Real>(s.x.col(i).norm());
            };
            const Real all =
                R + reach(before, a) + reach(before, b) + reach(after, a) + reach(after, b);
            sum += k * R * all;
        });
        return sum;
    }
};

/// The greatest gain of a step beyond the books, in what rounding may make of it.
struct Worst {
    Real gain = -1;
    Index touched = 0, shortened = 0;
};

/// Steps at what limit() certifies, from a state, and their books.
template <class System>
void keep_books(const System& system, typename System::State state,
                const taut::SelfContactOptions& options, int steps, Worst& worst) {
    using Scalar = typename System::Scalar;
    constexpr Real epsilon = std::numeric_limits<Scalar>::epsilon();
    taut::SelfContact contact(system, options);
    const AllPairs<System> pairs(system, contact);
    const typename StepAhead<System>::Points none =
        StepAhead<System>::Points::Zero(int(System::Dim), system.size());
    taut::EnergyStableEuler stepper(system);
    for (int step = 0; step < steps; ++step) {
        const Scalar h = contact.limit(state).certified;
        const auto before = state;
        const StepAhead<System> exact(system, state, static_cast<Real>(h), none);
        const Real energy = total_energy(system, state) + pairs.energy(state);
        const auto report = taut::step_through(stepper, state, h, 1, contact);
        REQUIRE(report);
        if (report.iterations != 1) {  // more pairs came into reach
            ++worst.shortened;
            continue;
        }
        Real work = static_cast<Real>(contact.work());
        for (Index i = 0; i < system.size(); ++i) {
            if (!system.is_pinned(i)) continue;
            const auto u = state.v.col(i).template cast<Real>().eval();
            work -= static_cast<Real>(h) * u.dot(exact.springs.col(i));
        }
        const Real touching = pairs.energy(state);
        worst.touched += touching > 0;
        const Real gain = total_energy(system, state) + touching - energy - work;
        const Real slack = epsilon * (exact.size + pairs.size(before, state));
        worst.gain = std::max(worst.gain, gain / slack);
    }
}

template <class Scalar, int Dim>
void throw_networks(Random& random, int scenes, Worst& worst) {
    using System = taut::SpringSystem<Scalar, Dim>;
    for (int scene = 0; scene < scenes; ++scene) {
        const auto system = random_network<System>(random, scene % 2 ? 1 : 3, scene % 3 == 0);
        if (taut::energy_limit(system).unbounded()) continue;
        taut::SelfContactOptions options;
        options.budget = random.below(2) ? 0.1 : random.uniform(0.02, 0.9);
        options.radius = random.uniform(0.3, 3);
        options.pairs = 1 + random.below(6);
        auto state = thrown(random, system);
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i) && random.below(2) > 0)
                state.v.col(i) = random.vector<Scalar, Dim>(-3, 3);
        }
        keep_books(system, state, options, 30, worst);
    }
}

/// Two layers, each a row of springs in every axis but the last one, thrown at each other along it.
template <class Scalar, int Dim>
void throw_layers(Random& random, int scenes, Worst& worst) {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    const Index side = Dim == 3 ? 5 : Dim == 2 ? 12 : 2;
    const Index across = Dim == 3 ? side : 1;
    for (int scene = 0; scene < scenes; ++scene) {
        taut::SpringSystem<Scalar, Dim> system;
        for (int layer = 0; layer < 2; ++layer) {
            const Vector shift = random.vector<Scalar, Dim>(-0.5, 0.5);
            const Index first = system.size();
            for (Index i = 0; i < side * across; ++i) {
                Vector x = shift;
                if (Dim > 1) x[0] += static_cast<Scalar>(i / across);
                if (Dim > 2) x[1] += static_cast<Scalar>(i % across);
                // In one dimension each layer has its pair in a row.
                x[Dim - 1] += static_cast<Scalar>(Dim == 1 ? 4 * layer + i : 2 * layer);
                system.add_particle(x, static_cast<Scalar>(random.uniform(0.5, 2)));
            }
            const auto k = static_cast<Scalar>(log_uniform(random, 10, 1000));
            for (Index i = 0; i < side * across; ++i) {
                if (i / across + 1 < side) system.add_spring(first + i, first + i + across, k);
                if (across > 1 && i % across + 1 < across)
                    system.add_spring(first + i, first + i + 1, k);
            }
        }
        auto state = system.initial_state();
        const auto speed = static_cast<Scalar>(log_uniform(random, 0.5, 50));
        const Index half = system.size() / 2;
        for (Index i = 0; i < system.size(); ++i) {
            state.v.col(i) = speed / 4 * random.vector<Scalar, Dim>(-1, 1);
            state.v(Dim - 1, i) += i < half ? speed : -speed;
        }
        keep_books(system, state, {}, 60, worst);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("self_contact: within the budget no step raises the energy", "[contact]",
                   (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    Random random(42);
    Worst networks, layers;
    throw_networks<typename TestType::Scalar, TestType::Dim>(random, 300, networks);
    throw_layers<typename TestType::Scalar, TestType::Dim>(random, 40, layers);
    CHECK(networks.gain < 8);
    CHECK(layers.gain < 8);
    CHECK(networks.touched > 1000);
    CHECK(layers.touched > 100);
}

TEMPLATE_TEST_CASE("self_contact: the budget is used up, and no more than that", "[contact]",
                   (Case<float, 3>), (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(7);
    for (int scene = 0; scene < 100; ++scene) {
        // Two balls at rest that overlap, each on a spring of its own, at rest, too.
        taut::SpringSystem<Scalar, Dim> system;
        const auto mass = static_cast<Scalar>(log_uniform(random, 0.1, 10));
        const auto stiffness = static_cast<Scalar>(log_uniform(random, 1, 1000));
        const Vector way = random.vector<Scalar, Dim>(-1, 1).normalized();
        const auto apart = static_cast<Scalar>(random.uniform(0.4, 0.95));
        for (const Scalar at : {Scalar(0), apart}) {
            const Index ball = system.add_particle(at * way, mass);
            const Scalar beyond = at > 0 ? at + 5 : Scalar(-5);
            system.pin(system.add_particle(beyond * way, mass));
            system.add_spring(ball, ball + 1, stiffness);
        }
        taut::SelfContactOptions options;
        options.budget = random.uniform(0.02, 0.9);
        options.pairs = 1;
        options.radius = 0.1;
        taut::SelfContact contact(system, options);
        auto state = system.initial_state();
        const double before = contact.energy(state);
        REQUIRE(before > 0);
        const auto alone = static_cast<double>(taut::energy_limit(system).certified);
        const Scalar h = contact.limit(state).certified;
        CHECK_THAT(static_cast<double>(h), WithinRel((1 - options.budget) * alone, 1e-5));
        taut::EnergyStableEuler stepper(system);
        REQUIRE(taut::step_through(stepper, state, h, 1, contact).iterations == 1);
        const double after = static_cast<double>(system.energy(state)) + contact.energy(state);
        // They part by what L_k leaves of M, so the energy of the pair goes into the motion so far.
        const double left = 1 - (1 - options.budget) * (1 - options.budget);
        const double kinetic = static_cast<double>(system.kinetic_energy(state));
        CHECK_THAT(kinetic, WithinRel(before * left, 1e-4));
        CHECK(after <= before * (1 + Tolerance<Scalar>::accumulated));
    }
}

TEMPLATE_TEST_CASE("self_contact: balls that would pass each other in a step do not", "[contact]",
                   (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(8);
    for (int scene = 0; scene < 100; ++scene) {
        taut::SpringSystem<Scalar, Dim> system;
        const Vector way = random.vector<Scalar, Dim>(-1, 1).normalized();
        const auto apart = static_cast<Scalar>(random.uniform(0.3, 1.1));
        for (const Scalar at : {Scalar(0), apart}) {
            const Index ball = system.add_particle(at * way, 1);
            system.pin(system.add_particle((at > 0 ? at + 50 : Scalar(-50)) * way, 1));
            system.add_spring(ball, ball + 1, 10);
        }
        taut::SelfContactOptions options;
        options.budget = 0.9;
        options.pairs = 1;
        options.radius = 0.01;
        taut::SelfContact contact(system, options);
        auto state = system.initial_state();
        const Scalar h = contact.limit(state).certified;
        const auto speed = static_cast<Scalar>(random.uniform(0.5, 5)) / h;
        state.v.col(0) = speed * way;
        state.v.col(2) = -speed * way;
        taut::EnergyStableEuler stepper(system);
        REQUIRE(taut::step_through(stepper, state, h, 1, contact));
        CHECK((state.x.col(2) - state.x.col(0)).dot(way) > 0);
    }
}

TEMPLATE_TEST_CASE("self_contact: a guard books the energy of pairs", "[contact]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = taut::SpringSystem<Scalar, Dim>;
    Random random(9);
    Index touched = 0, trimmed = 0, again = 0;
    for (int scene = 0; scene < 60; ++scene) {
        const auto system = random_network<System>(random, 1, scene % 3 == 0);
        if (taut::energy_limit(system).unbounded()) continue;
        taut::SelfContactOptions options;
        options.radius = random.uniform(0.3, 2);
        taut::SelfContact contact(system, options);
        const AllPairs<System> pairs(system, contact);
        taut::Guarded guard(system);
        auto state = thrown(random, system);
        const auto frame = contact.limit(state).certified * static_cast<Scalar>(20);
        double before = 0, balance = 0, reported = 0;
        for (int n = 0; n < 30; ++n) {
            const auto report = guard.advance(state, frame, contact);
            REQUIRE(report);
            // Of all particles: pins at rest hold energy that is no part's, and always the same.
            const auto touching = static_cast<double>(pairs.energy(state));
            const double energy = static_cast<double>(total_energy(system, state)) + touching;
            const double size = std::abs(energy) + touching + report.slack / 1e-12;
            if (n > 0) {
                CHECK_THAT(report.energy - reported, WithinAbs(energy - before, 1e-11 * size));
                CHECK(energy - before - report.work <=
                      report.balance - balance + report.slack + 1e-11 * size);
            }
            reported = report.energy;
            touched += contact.touching();
            trimmed += report.trimmed;
            again += report.again;
            before = energy;
            balance = report.balance;
        }
    }
    CHECK(touched > 300);
    CHECK(trimmed > 0);
    CHECK(again > 0);
}

}  // namespace taut_test::self_contact_test
