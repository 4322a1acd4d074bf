// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/imex/imex.hpp>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/model/state_view.hpp>
#include <taut/stability/energy_limit.hpp>

#include "../support/catch.hpp"
#include "../support/hemmed_cloth.hpp"
#include "../support/message.hpp"
#include "../support/sweep_checks.hpp"
#include "../support/tolerance.hpp"
#include "direct_imex.hpp"

namespace taut_test::imex_test {

using taut::EnergyStableEuler;
using taut::Hookean;
using taut::ImexEuler;
using taut::SpringSystem;

namespace {

/// A third of the springs wholly implicit, a third in part.
double mixed_share(Index s) { return s % 3 == 0 ? 1 : s % 3 == 1 ? 0.25 : 0; }

template <class System>
void check_written_out(std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    Random random(seed);
    for (int repeat = 0; repeat < 16; ++repeat) {
        INFO("system " << repeat);
        RandomOptions options;
        options.particles = 24;
        options.springs = 30;
        options.dampers = repeat % 3 == 0;
        options.rayleigh = repeat % 4 < 2;
        auto system = random_like<System>(random, options);
        // Where a tension falls, φ hangs on what is left of a difference of energies.
        const bool falls = repeat % 2 == 1;
        if (!falls) system.template remove_springs<Glue>([](Index) { return true; });
        typename DirectImex<System>::Points forces =
            DirectImex<System>::Points::Zero(Dim, system.size());
        for (Index i = 0; repeat % 5 == 0 && i < system.size(); ++i) {
            system.set_constant_force(i, random.vector<Scalar, Dim>(-10, 10));
            if (!system.is_pinned(i))
                forces.col(i) = system.external_forces().constant.col(i).template cast<Real>();
        }
        const double step = 0.1;
        ImexEuler<System> stepper(system, {step, mixed_share, 1});
        const auto matrices = imex_matrices(system, step, mixed_share);
        CHECK(stepper.implicit_springs() >= system.spring_count() / 2);
        for (const double part : {1.0, 0.25}) {
            auto state = random_state(random, system);  // of pins that move, too
            const auto h = static_cast<Scalar>(part * step);
            const DirectImex<System> exact(system, matrices, state, static_cast<Real>(h), forces);
            REQUIRE(stepper.step(state, h));
            const double scale = static_cast<double>(exact.v.cwiseAbs().maxCoeff());
            const double tolerance = (falls ? 64 : 1) * Tolerance<Scalar>::rounding * scale;
            CHECK(distance(state.v, exact.v) <= tolerance);
            CHECK(distance(state.x, exact.x) <= tolerance);
            const auto added = static_cast<double>(added_energy(system, matrices, state));
            CHECK_THAT(stepper.added_kinetic(state), WithinRel(added, 1e-12));
        }
        CHECK(stepper.factorizations() == 1);
    }
}

/// As one with the system as it is: the inertia belongs to it.
template <class System>
void check_renewed(const System& system, ImexEuler<System>& stepper, double step,
                   std::int64_t factorizations) {
    auto state = system.initial_state();
    Random random(5);
    state.v = random.points<double, System::Dim>(system.size(), -1, 1);
    auto expected = state;
    ImexEuler<System> fresh(system, {step, {}, 1});
    REQUIRE(stepper.step(state, step, 3));
    REQUIRE(fresh.step(expected, step, 3));
    CHECK(same_bits(state, expected));
    CHECK(stepper.factorizations() == factorizations);
    CHECK(stepper.limit().revision == system.revision());
    CHECK(stepper.limit().certified == fresh.limit().certified);
    CHECK(stepper.implicit_springs() == fresh.implicit_springs());
    CHECK(stepper.added_kinetic(state) == fresh.added_kinetic(state));
}

}  // namespace

TEMPLATE_TEST_CASE("imex: a step is A's formula written out", "[imex]", (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    check_written_out<AnyLaw<typename TestType::Scalar, TestType::Dim>>(8710);
}

TEMPLATE_TEST_CASE("imex: where no spring needs it, it is EnergyStableEuler to the bit", "[imex]",
                   (Case<double, 1>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    using System = SpringSystem<Scalar, TestType::Dim>;
    Random random(8720);
    for (int repeat = 0; repeat < 12; ++repeat) {
        RandomOptions options;
        options.dampers = repeat % 2 == 0;
        options.rayleigh = repeat % 3 == 0;
        const auto system = random_like<System>(random, options);
        // A third: the bounds by rows are wider than what is certified.
        const Scalar h = taut::energy_limit(system).certified / 3;
        ImexEuler<System> stepper(system, {static_cast<double>(h), {}, 1});
        CHECK(stepper.implicit_springs() == 0);
        CHECK(stepper.touched() == 0);
        CHECK(stepper.limit().certified == h);
        EnergyStableEuler<System> plain(system);
        auto state = random_state(random, system);
        auto expected = state;
        REQUIRE(stepper.step(state, h, 9));
        REQUIRE(plain.step(expected, h, 9));
        CHECK(same_bits(state, expected));
        CHECK(stepper.added_kinetic(state) == 0);
    }
}

TEMPLATE_TEST_CASE("imex: the sweep's corrected steps ahead are those of the plain path", "[imex]",
                   (Case<double, 1>), (Case<double, 3>), (Case<float, 2>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(8730);
    const auto check = [&](const auto& system) {
        using Vector = Eigen::Matrix<Scalar, Dim, 1>;
        const auto correct = [&](const auto& a, const auto& v) {
            for (Index i = 0; i < system.size(); i += 2)
                a.set(i, Vector(Vector(a(i)) / 2 - Vector(v(i))));
        };
        const auto start = random_state(random, system);
        auto state = start, expected = start;
        const auto h = static_cast<Scalar>(0.01);
        taut::integrator_detail::sweep::Sweep<std::decay_t<decltype(system)>> sweep;
        REQUIRE(sweep.template run_corrected<true>(system, state, h, 20, 1, correct));
        taut::integrator_detail::ExplicitSteps<std::decay_t<decltype(system)>> plain({});
        for (int i = 0; i < 20; ++i)
            plain.template corrected_step<true>(system, expected, h, correct);
        CHECK(distance(state.v, start.v) > 1e-3);
        CHECK(distance(state.v, expected.v) <=
              16 * Tolerance<Scalar>::rounding * largest(expected.v));
        CHECK(distance(state.x, expected.x) <=
              16 * Tolerance<Scalar>::rounding * largest(expected.x));
    };
    for (int repeat = 0; repeat < 4; ++repeat) {
        auto system = repeat % 2 == 0 ? net<Scalar, Dim>(random, 9, 12)
                                      : irregular<Scalar, Dim>(random, 700, true);
        if (repeat > 1) system.set_external_force([](const auto& s, auto& f) { f += s.x; });
        check(System(system));
    }
    // A law that does not push reads one set of positions, which must not be what is corrected.
    using String = SpringSystem<Scalar, Dim, TensionOnly>;
    RandomOptions options;
    options.particles = 60;
    options.springs = 150;
    check(random_like<String>(random, options));
}

TEMPLATE_TEST_CASE("imex: counts and views give the same bits", "[imex]", (Case<double, 2>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(8740);
    const auto system = irregular<Scalar, Dim>(random, 1500, true);
    const double step = 8 * static_cast<double>(taut::energy_limit(system).certified);
    ImexEuler<System> stepper(system, {step, {}, 1});
    CHECK(stepper.implicit_springs() > 0);
    const Scalar h = stepper.limit().certified;
    const auto start = random_state(random, system);
    auto at_once = start, one_by_one = start, viewed = start;
    REQUIRE(stepper.step(at_once, h, 70));
    for (int i = 0; i < 70; ++i) REQUIRE(stepper.step(one_by_one, h));
    taut::StateView<Scalar, Dim> view(viewed.x.data(), viewed.v.data(), system.size());
    REQUIRE(stepper.step(view, h, 70));
    CHECK(same_bits(at_once, one_by_one));
    CHECK(at_once.x == viewed.x);
    CHECK(at_once.v == viewed.v);
}

TEMPLATE_TEST_CASE("imex: a cloth with a stiff hem takes the step of the cloth", "[imex]",
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const auto even = hemmed_cloth<Scalar, Dim>(12, 16, 1);
    const auto limit = static_cast<double>(taut::energy_limit(even).certified);
    for (const double stiffer : {10.0, 1e3, 1e6}) {
        INFO("hem times " << stiffer);
        const auto cloth = hemmed_cloth<Scalar, Dim>(12, 16, stiffer);
        ImexEuler<SpringSystem<Scalar, Dim>> stepper(cloth, {0.8 * limit, {}, 1});
        CHECK(stepper.limit().certified == static_cast<Scalar>(0.8 * limit));
        Index index = 0;
        cloth.visit_springs([&](const auto& spring) {
            CHECK(stepper.share(index++) == (spring.stiffness_bound() > 1 ? 1 : 0));
        });
        CHECK(stepper.touched() == 16);
    }
}

TEST_CASE("imex: an edit makes the inertia anew, nothing else does", "[imex]") {
    using System = SpringSystem<double, 3>;
    Random random(8750);
    RandomOptions options;
    options.particles = 20;
    options.springs = 60;
    auto system = random_like<System>(random, options);
    const double step = 10 * static_cast<double>(taut::energy_limit(system).certified);
    ImexEuler<System> stepper(system, {step, {}, 1});
    std::int64_t made = 1;
    check_renewed(system, stepper, step, made);
    system.set_gravity({0, 0, -1});
    check_renewed(system, stepper, step, made);
    auto state = system.initial_state();
    REQUIRE(stepper.step(state, step / 7));
    CHECK(stepper.factorizations() == made);
    system.set_stiffness(3, 1e5);
    check_renewed(system, stepper, step, ++made);
    system.remove_spring(5);
    check_renewed(system, stepper, step, ++made);
    system.unpin(0);
    check_renewed(system, stepper, step, ++made);
    system.pin(7);
    check_renewed(system, stepper, step, ++made);
    system.set_mass(9, 0.01);
    check_renewed(system, stepper, step, ++made);
    system.set_rayleigh({0.1, 0.01});
    check_renewed(system, stepper, step, ++made);
    system.add_particle({2, 0, 0}, 0.1);
    system.add_spring(9, 20, 1e4);
    check_renewed(system, stepper, step, ++made);
    system.remove_springs([](Index) { return true; });
    check_renewed(system, stepper, step, made);
}

TEST_CASE("imex: shares that are given certify what they leave", "[imex]") {
    using System = SpringSystem<double, 2>;
    Random random(8760);
    for (int repeat = 0; repeat < 20; ++repeat) {
        RandomOptions options;
        options.springs = 20;
        options.dampers = repeat % 2 == 0;
        auto system = random_like<System>(random, options);
        const double none = taut::energy_limit(system).certified;
        const auto certified = [&](double share) {
            return ImexEuler<System>(system, {20 * none, [=](Index) { return share; }, 1})
                .limit()
                .certified;
        };
        CHECK_THAT(certified(0), WithinRel(none, 1e-9));
        CHECK(certified(0.5) > 1.3 * none);
        CHECK(certified(0.5) < 2.1 * none);
        CHECK(certified(1) == 20 * none);
        // No spring takes drag off the step.
        system.set_rayleigh({0.2 / none, 0});
        CHECK_THAT(certified(1), WithinRel(10 * none, 1e-9));
        CHECK_THAT((ImexEuler<System>(system, {20 * none, {}, 1}).limit().certified),
                   WithinRel(10 * none, 1e-9));
    }
}

TEMPLATE_TEST_CASE("imex: without pins the momentum is kept", "[imex]", (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(8770);
    RandomOptions options;
    options.particles = 30;
    options.springs = 90;
    options.pinned = 0;
    options.gravity = false;
    options.dampers = true;
    const auto system = random_like<System>(random, options);
    const double step = 30 * static_cast<double>(taut::energy_limit(system).certified);
    ImexEuler<System> stepper(system, {step, {}, 1});
    CHECK(stepper.implicit_springs() > 30);
    auto state = random_state(random, system);
    const auto momentum = [&] {
        Eigen::Matrix<Real, Dim, 1> sum = Eigen::Matrix<Real, Dim, 1>::Zero();
        for (Index i = 0; i < system.size(); ++i)
            sum += static_cast<Real>(system.mass(i)) * state.v.col(i).template cast<Real>();
        return sum;
    };
    const Eigen::Matrix<Real, Dim, 1> start = momentum();
    const auto before = state.v;
    REQUIRE(stepper.step(state, stepper.limit().certified, 200));
    CHECK(distance(state.v, before) > 0.1);
    CHECK(static_cast<double>((momentum() - start).norm()) <=
          Tolerance<Scalar>::accumulated * largest(before));
}

TEST_CASE("imex: wrong options, steps and states are refused", "[imex][bad_input]") {
    using System = SpringSystem<double, 2>;
    Random random(8780);
    const auto system = random_like<System>(random);
    const auto message = [&](const taut::ImexOptions& options) {
        return message_of([&] { ImexEuler<System>(system, options); });
    };
    for (const double step : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK(missing(message({step, {}, 1}), {"ImexEuler", "step"}) == "");
    for (const double share : {-0.1, 1.1, std::nan("")}) {
        const auto one = [=](Index s) { return s == 4 ? share : 0; };
        CHECK(missing(message({0.1, one, 1}), {"ImexEuler", "share of spring 4", "[0, 1]"}) == "");
    }
    CHECK(missing(message({0.1, {}, 0}), {"threads", "0"}) == "");
    ImexEuler<System> stepper(system, {1, {}, 1});
    auto state = random_state(random, system);
    const auto before = state;
    for (const double h : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK(stepper.step(state, h).status == taut::Status::invalid_step);
    CHECK(same_bits(state, before));
    CHECK(stepper.step(state, 1, 0));
    CHECK(same_bits(state, before));
    state.v(0, 3) = std::nan("");
    const auto broken = stepper.step(state, 1);
    CHECK(broken.status == taut::Status::invalid_state);
    CHECK(broken.where == 3);
    // Beyond the digits of double nothing is left of the masses.
    ImexEuler<System> lost(system, {1e12, {}, 1});
    state = before;
    CHECK(lost.step(state, 1).status == taut::Status::masses_lost);
    CHECK(lost.limit().certified == 0);
    CHECK(same_bits(state, before));
    System empty;
    ImexEuler<System> idle(empty, {1, {}, 1});
    auto nothing = empty.initial_state();
    CHECK(idle.step(nothing, 1));
    // Far above every limit it overflows; the state is as before.
    state.v *= 1e300;
    const auto fast = state;
    CHECK_FALSE(stepper.step(state, 1e6, 100));
    CHECK(same_bits(state, fast));
}

}  // namespace taut_test::imex_test
