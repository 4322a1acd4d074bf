// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

// A stepper that goes on while springs are cut, added and changed and pins come and go must do what
// one would that has never seen the scene before.

namespace taut_test::edited_system_test {

namespace {

using Cloth = taut::SpringSystem<double, 3>;

void edit(Random& random, Cloth& cloth, int kind) {
    const Index s = random.below(cloth.spring_count());
    const Index i = 1 + random.below(cloth.size() - 1);
    switch (kind) {
        case 0: cloth.remove_spring(s); break;
        case 1: cloth.remove_springs([&](Index k) { return k % 17 == s % 17; }); break;
        case 2: cloth.set_stiffness(s, random.uniform(10, 500)); break;
        case 3: cloth.add_spring(i, i - 1, 50); break;
        case 4: cloth.is_pinned(i) ? cloth.unpin(i) : cloth.pin(i); break;
    }
}

template <class Stepper>
void check_follows_edits(double h) {
    Random random(71);
    taut::ClothOptions options;
    options.rows = options.columns = 7;
    auto cloth = taut::hanging_cloth<double>(options);
    auto state = cloth.initial_state();
    state.v.row(1).setLinSpaced(-0.2, 0.2);
    Stepper stepper(cloth);
    for (int round = 0; round < 15; ++round) {
        INFO("round " << round);
        auto fresh = state;
        Stepper anew(cloth);
        REQUIRE(stepper.step(state, h, 3));
        REQUIRE(anew.step(fresh, h, 3));
        CHECK((state.x - fresh.x).norm() <= 1e-12 * fresh.x.norm());
        CHECK((state.v - fresh.v).norm() <= 1e-9 * (1 + fresh.v.norm()));
        edit(random, cloth, round % 5);
    }
}

}  // namespace

TEST_CASE("edited system: every stepper follows", "[integrator]") {
    check_follows_edits<taut::SymplecticEuler<Cloth>>(1e-4);
    check_follows_edits<taut::VelocityVerlet<Cloth>>(1e-4);
    check_follows_edits<taut::ImplicitEuler<Cloth>>(1e-2);
    check_follows_edits<taut::ProjectiveDynamics<Cloth>>(1e-2);
}

TEST_CASE("edited system: a guard certifies again, and lets a torn cloth fall", "[integrator]") {
    auto cloth = taut::hanging_cloth<double>({10, 10});
    taut::Guarded<taut::SymplecticEuler<Cloth>> guard(cloth);
    auto state = cloth.initial_state();
    for (int frame = 0; frame < 40; ++frame) {
        if (frame % 10 == 5) {
            const Index row = 10 * (frame / 10 + 2);  // between this particle and the one above it
            cloth.remove_springs([&](Index s) {
                const auto& set = cloth.springs();
                return (set.a[s] < row) != (set.b[s] < row);
            });
        }
        REQUIRE(guard.advance(state, 1.0 / 60));
        CHECK(guard.limit()->revision == cloth.revision());
    }
    // Free fall of what the first cut let go, which holds more than half of the cloth.
    const double fallen = cloth.initial_state().x(2, 99) - state.x(2, 99);
    CHECK(fallen > 0.4);
    CHECK(state.x(2, 0) == cloth.initial_state().x(2, 0));
}

}  // namespace taut_test::edited_system_test
