// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/random.hpp"

// A stepper that goes on while springs are cut, added and changed, pins come and go and the scene
// is assigned another one must do what one would that has never seen the scene before.

namespace taut_test::edited_system_test {

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using Linear = taut::LinearSystem<double>;

Cloth cloth_of(double stretch) {
    taut::ClothOptions options{7, 7};
    options.stretch = stretch;
    return taut::hanging_cloth<double>(options);
}

void edit(Random& random, Cloth& cloth, int round) {
    const Index s = random.below(cloth.spring_count());
    const Index i = 1 + random.below(cloth.size() - 1);
    switch (round % 5) {
        case 0: cloth.remove_spring(s); break;
        case 1: cloth.remove_springs([&](Index k) { return k % 17 == s % 17; }); break;
        case 2: cloth.set_stiffness(s, random.uniform(10, 500)); break;
        case 3: cloth.add_spring(i, i - 1, 50); break;
        case 4: cloth.is_pinned(i) ? cloth.unpin(i) : cloth.pin(i); break;
    }
}

template <class Stepper, class System>
void check_follows(System system, double h, int rounds,
                   const std::function<void(System&, int)>& change) {
    auto state = system.initial_state();
    state.v.row(state.v.rows() / 2).setLinSpaced(-0.2, 0.2);
    Stepper stepper(system);
    for (int round = 0; round < rounds; ++round) {
        INFO("round " << round);
        auto fresh = state;
        Stepper anew(system);
        REQUIRE(stepper.step(state, h, 3));
        REQUIRE(anew.step(fresh, h, 3));
        CHECK((state.x - fresh.x).norm() <= 1e-12 * (1 + fresh.x.norm()));
        CHECK((state.v - fresh.v).norm() <= 1e-9 * (1 + fresh.v.norm()));
        change(system, round);
    }
}

template <class Stepper>
void check_follows(double h) {
    Random random(71);
    check_follows<Stepper, Cloth>(cloth_of(1000), h, 15,
                                  [&](Cloth& cloth, int round) { edit(random, cloth, round); });
    // Built by as many calls.
    check_follows<Stepper, Cloth>(cloth_of(1000), h, 2,
                                  [&](Cloth& cloth, int) { cloth = cloth_of(100); });
}

/// A net whose springs fit runs, batches or, in a garment's disorder, stars.
template <class System>
System net_of(Random& random, Index n) {
    using Scalar = typename System::Scalar;
    System net;
    for (Index i = 0; i < n; ++i) {
        net.add_particle(random.vector<Scalar, System::Dim>(-1, 1), Scalar(random.uniform(0.1, 1)));
    }
    const bool grid = random.below(2) == 0;
    for (Index s = 0; s < 4 * n; ++s) {
        const Index a = random.below(n - 5);
        const Index b = grid ? a + 1 + s % 5 : (a + 1 + random.below(n - 2)) % n;
        if (a != b) net.add_spring(a, b, Scalar(random.uniform(10, 100)));
    }
    return net;
}

/// One step by a stepper that has gone through edits, other states and divergence, and by a fresh
/// one: the same bits.
template <template <class> class Stepper, class System>
void check_bits(std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    System net = net_of<System>(random, 40 + random.below(600));
    Stepper<System> stepper(net);
    auto state = net.initial_state(), other = state;
    // With damping velocity Verlet goes on with a force at v½, where a fresh one begins at v.
    const bool damped = Stepper<System>::method != taut::Method::velocity_verlet;
    for (int round = 0; round < 40; ++round) {
        INFO(name(Stepper<System>::method) << ", seed " << seed << ", round " << round);
        const Index i = random.below(net.size());
        switch (random.below(12)) {
            case 0: net.set_mass(i, Scalar(random.uniform(0.1, 2))); break;
            case 1: net.is_pinned(i) ? net.unpin(i) : net.pin(i); break;
            case 2: net.remove_spring(random.below(net.spring_count())); break;
            case 3:
                if (!damped) break;
                net.set_rayleigh({random.uniform(0, 1), random.below(2) == 0 ? 0 : 1e-4});
                break;
            case 4: net.set_stiffness(random.below(net.spring_count()), Scalar(50)); break;
            case 5:
                net.add_spring(i, (i + 1) % net.size(), Scalar(20),
                               damped ? Scalar(random.uniform(0, 0.1)) : Scalar(0));
                break;
            case 6: net = net_of<System>(random, net.size()); break;
            case 7: {
                auto wild = state;
                wild.v.col(i).setConstant(std::numeric_limits<Scalar>::max() / 2);
                CHECK_FALSE(stepper.step(wild, Scalar(10), 1 + random.below(3)));
                break;
            }
            case 8: std::swap(state, other); break;
            default: break;
        }
        auto fresh = state;
        Stepper<System> anew(net);
        const Scalar h = Scalar(random.uniform(0.5e-3, 1e-3));
        REQUIRE(stepper.step(state, h));
        REQUIRE(anew.step(fresh, h));
        CHECK(state.x == fresh.x);
        CHECK(state.v == fresh.v);
    }
}

template <class System>
void check_bits(std::uint32_t seed) {
    check_bits<taut::SymplecticEuler, System>(seed);
    check_bits<taut::ExplicitEuler, System>(seed);
    check_bits<taut::VelocityVerlet, System>(seed);
    check_bits<taut::EnergyStableEuler, System>(seed);
}

}  // namespace

TEST_CASE("edited_system: a single step has the bits of a fresh stepper's, whatever came before",
          "[integrator]") {
    for (std::uint32_t seed = 4700; seed < 4710; ++seed) {
        check_bits<taut::SpringSystem<float, 3>>(seed);
        check_bits<taut::SpringSystem<double, 3>>(seed);
        check_bits<taut::SpringSystem<double, 2>>(seed);
        check_bits<taut::SpringSystem<float, 1>>(seed);
    }
}

TEST_CASE("edited_system: every stepper follows", "[integrator]") {
    check_follows<taut::SymplecticEuler<Cloth>>(1e-4);
    check_follows<taut::ExplicitEuler<Cloth>>(1e-5);
    check_follows<taut::VelocityVerlet<Cloth>>(1e-4);
    check_follows<taut::EnergyStableEuler<Cloth>>(1e-4);
    check_follows<taut::ImplicitEuler<Cloth>>(1e-2);
    check_follows<taut::ProjectiveDynamics<Cloth>>(1e-2);
    const auto matrices = [](double stretch) {
        const Cloth cloth = cloth_of(stretch);
        return taut::linearize(cloth, cloth.initial_state());
    };
    const auto change = [&](Linear& system, int) { system = matrices(100); };
    check_follows<taut::ImplicitEuler<Linear>, Linear>(matrices(1000), 1e-2, 2, change);
    check_follows<taut::Bdf2<Linear>, Linear>(matrices(1000), 1e-2, 2, change);
}

TEST_CASE("edited_system: a limit of another system is refused", "[integrator]") {
    Cloth cloth = cloth_of(100);
    const auto limit = taut::any_pose_limit(cloth);
    REQUIRE(limit.step_for(cloth, 0.9).has_value());
    cloth = cloth_of(1000);
    CHECK_FALSE(limit.step_for(cloth, 0.9).has_value());
}

}  // namespace taut_test::edited_system_test
