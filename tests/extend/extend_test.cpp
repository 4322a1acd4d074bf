// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/proof/stability.hpp>
#include <taut/taut.hpp>

#include "../support/catch.hpp"
#include "../support/sweep_checks.hpp"

// A law, an integrator and a limit of a program's own: by what Taut's headers offer, nothing added
// to them. CONTRIBUTING.md walks through this file.

namespace taut_test::extend_test {

/// A spring that stiffens: T = k u (1 + a|u|/(w + |u|)), u = l − L. T′ rises from k to k(1 + a).
struct Stiffening {
    static constexpr bool convex = false;
    static constexpr bool monotone = true;
    static constexpr bool vectorizable = true;

    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  ///< k, N/m
        Scalar more;       ///< a
        Scalar width;      ///< w, m

        void require_valid(const char* where) const {
            taut::require_non_negative(where, "stiffness", stiffness);
            taut::require_non_negative(where, "more", more);
            taut::require_positive(where, "width", width);
        }
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness), static_cast<Other>(more),
                    static_cast<Other>(width)};
        }
    };

    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = l - L, r = size(u);
        return p.stiffness * u * (Scalar(1) + p.more * r / (p.width + r));
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar left = p.width / (p.width + size(l - L));
        return p.stiffness * (Scalar(1) + p.more * (Scalar(1) - left * left));
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = std::abs(l - L), w = p.width;
        return p.stiffness * (u * u / 2 + p.more * (u * u / 2 - w * u + w * w * std::log1p(u / w)));
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness * (Scalar(1) + p.more);
    }

private:
    template <class Scalar>
    static Scalar size(Scalar u) {
        using std::max;
        return max(u, Scalar(0) - u);
    }
};

template <class Scalar>
Stiffening::Parameters<Scalar> draw_parameters(Random& random, Stiffening) {
    const auto stiffness = static_cast<Scalar>(random.uniform(20, 200));
    const auto more = static_cast<Scalar>(random.uniform(0, 3));
    return {stiffness, more, static_cast<Scalar>(random.uniform(0.01, 1))};
}

/// Leapfrog whose drag c, 1/s, is taken half at either end of the step:
///     v⁺ = ((1 − hc/2) v + h f/m)/(1 + hc/2),  x⁺ = x + h v⁺.
/// On a mode of stiffness k and damping d of the system its multipliers solve
///     (1 + hc/2) μ² − (2 − hd − h²k) μ + 1 − hc/2 − hd = 0,
/// which leave the unit circle at 2hd + h²k = 4, whatever c is.
template <class System>
class DragLeapfrog {
public:
    DragLeapfrog(const System& system, double drag) : system_(&system), drag_(drag) {}

    taut::Report step(typename System::State& state, typename System::Scalar h, Index count = 1) {
        using Scalar = typename System::Scalar;
        const Scalar half = h * static_cast<Scalar>(drag_) / 2;
        for (Index i = 0; i < count; ++i) {
            system_->force(state, f_);
            const auto a = f_.array().rowwise() * system_->inverse_mass().transpose().array();
            state.v.array() = ((1 - half) * state.v.array() + h * a) / (1 + half);
            state.x += h * state.v;
            state.time += h;
            if (!state.finite()) return {taut::Status::diverged};
        }
        return {};
    }
    /// Its condition, for Stability::max_step: 2hD + h²K⁺ ≺ 4M. The first h fulfils it; from h to
    /// s·h, s ≥ 1, the sum grows by s² at most.
    static double certified(const taut::Pencil& pencil) {
        using namespace taut::matrices;
        const double h = 2 / (pencil.upper_bound(D) + std::sqrt(pencil.upper_bound(K_plus)));
        const double sum = std::isinf(h) ? 0 : pencil.upper_bound(2 * h * D + h * h * K_plus);
        return h * std::sqrt(4 / sum);
    }

private:
    const System* system_;
    double drag_;
    typename System::Force f_;
};

namespace {

template <class Scalar>
using Chain = taut::SpringSystem<Scalar, 1>;

constexpr Index masses = 40;

template <class Scalar>
Chain<Scalar> chain() {
    return taut::chain<Scalar>({masses, taut::ChainEnds::fixed_fixed, 0.5, 200});
}

}  // namespace

TEMPLATE_TEST_CASE("extend: the limit of an integrator of one's own is the chain's closed form",
                   "[extend]", float, double) {
    const auto system = chain<TestType>();
    const auto rest = system.initial_state();
    const taut::Stability<TestType> stability(system, rest);
    const auto limit = stability.max_step(DragLeapfrog<Chain<TestType>>::certified);
    const double angle = double(masses) / double(masses + 1) * std::acos(-1.0) / 2;
    const double exact = 1 / (std::sqrt(200 / 0.5) * std::sin(angle));
    CHECK(limit.certified <= exact);
    CHECK(limit.certified >= 0.998 * exact);
    CHECK(limit.cause == taut::Cause::stiffness);
    CHECK(limit.revision == system.revision());
    CHECK(limit.step_for(system, TestType(0.5)) == limit.certified / 2);

    // Drag of the system is taken whole, as by symplectic Euler, and costs both as much.
    auto dragged = system;
    dragged.set_rayleigh({8, 0});
    const taut::Stability<TestType> whole(dragged, rest);
    const auto symplectic = whole.max_step(taut::Method::symplectic_euler).certified;
    const auto own = whole.max_step(DragLeapfrog<Chain<TestType>>::certified).certified;
    CHECK((own <= symplectic && own >= TestType(0.99) * symplectic));

    for (const double drag : {0.0, 1e-3, 8.0, 1000.0}) {
        INFO("drag " << drag);
        DragLeapfrog<Chain<TestType>> stepper(system, drag);
        auto state = rest;
        for (Index i = 0; i < masses; ++i) state.v(0, i) = TestType(i % 2 == 0 ? 1e-3 : -1e-3);
        const auto start = state;
        REQUIRE(stepper.step(state, TestType(0.999) * limit.certified, 4000));
        CHECK((state.x - rest.x).cwiseAbs().maxCoeff() < TestType(0.1));
        state = start;
        const bool finite = bool(stepper.step(state, TestType(1.01 * exact), 4000));
        if (drag <= 1e-3) CHECK((!finite || (state.x - rest.x).cwiseAbs().maxCoeff() > 10));
    }
}

TEMPLATE_TEST_CASE("extend: a condition of one's own is rounded, and says what limits nothing",
                   "[extend]", float, double) {
    const auto system = chain<TestType>();
    const taut::Stability<TestType> stability(system, system.initial_state());
    const auto of = [&](double h) {
        return stability.max_step([=](const taut::Pencil&) { return h; });
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(static_cast<double>(of(0.1).certified) <= 0.1);
    CHECK(std::isinf(of(infinity).certified));
    CHECK(of(infinity).cause == taut::Cause::nothing_to_limit);
    for (const double nothing : {0.0, -1.0, -infinity, std::nan(""), 1e-320})
        CHECK(of(nothing).certified <= TestType(1e-320));
    Chain<TestType> held;
    held.add_particle(typename Chain<TestType>::Vector(TestType(0)), TestType(1));
    held.pin(0);
    const taut::Stability<TestType> empty(held, held.initial_state());
    CHECK(std::isinf(empty.max_step([](const taut::Pencil&) { return 1.0; }).certified));
}

TEST_CASE("extend: a condition of one's own holds at any pose, by the graph's pencil", "[extend]") {
    const auto cloth = taut::hanging_cloth<double>({9, 7});
    const auto graph = taut::Pencil::any_pose(cloth);
    REQUIRE(graph.lost().empty());  // else it says nothing about the cloth
    const double own = DragLeapfrog<decltype(cloth)>::certified(graph);
    CHECK(std::abs(own / taut::any_pose_limit(cloth).certified - 1) <= 1e-12);
}

TEST_CASE("extend: a condition tells of compressed springs", "[extend]") {
    auto cloth = taut::hanging_cloth<double>({9, 7});
    auto state = cloth.initial_state();
    state.x *= 0.9;
    const taut::Stability<double> stability(cloth, state);
    const auto limit = stability.max_step(DragLeapfrog<decltype(cloth)>::certified);
    CHECK(limit.admitted_growth > 0);
    CHECK(limit.admitted_growth ==
          stability.max_step(taut::Method::symplectic_euler).admitted_growth);
}

namespace {

template <class Scalar, int Dim>
void check_law(Random& random) {
    RandomOptions options;
    options.particles = 60;
    options.springs = 200;
    options.pinned = 0;
    options.gravity = false;
    const auto system = random_system<Scalar, Dim, Stiffening>(random, options);
    const auto start = random_state(random, system);
    check_equals_plain_path<taut::SymplecticEuler>(system, start);

    const auto limit = taut::energy_limit(system);
    taut::EnergyStableEuler stepper(system);
    auto state = start;
    double energy = system.energy(state);
    const double rounding = 4000 * std::numeric_limits<Scalar>::epsilon() * energy;
    for (int i = 0; i < 200; ++i) {
        REQUIRE(stepper.step(state, limit.certified));
        const double now = system.energy(state);
        REQUIRE(now <= energy + rounding);
        energy = now;
    }
}

}  // namespace

TEST_CASE("extend: a law of one's own runs in the sweep and keeps the promise of its bound",
          "[extend]") {
    Random random(91);
    for (int repeat = 0; repeat < 5; ++repeat) {
        check_law<float, 1>(random);
        check_law<float, 2>(random);
        check_law<float, 3>(random);
        check_law<double, 1>(random);
        check_law<double, 2>(random);
        check_law<double, 3>(random);
    }
}

}  // namespace taut_test::extend_test
