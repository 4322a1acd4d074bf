// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What a guard spends on frames that it gives up.
#include <taut/integrator/guarded.hpp>

#include "../support/catch.hpp"
#include "../support/leaking.hpp"
#include "../support/random_system.hpp"

namespace taut_test::refinement_test {

using taut::Guarded;
using taut::Status;

namespace {

constexpr Index plain = 4;  // substeps of a frame that is not refined

/// A scene that flies, and its guard.
template <class Scalar>
struct Flight {
    using System = taut::SpringSystem<Scalar, 2>;
    using Guard = Guarded<Leaking<System>>;

    explicit Flight(std::uint32_t seed, int retries) : random(seed) {
        RandomOptions options;
        options.pinned = 0;
        options.gravity = false;
        system = random_like<System>(random, options);
        state = system.initial_state();
        state.v.setConstant(100);
        frame = Scalar(0.5) * static_cast<Scalar>(plain) * taut::any_pose_limit(system).certified;
        frame *= Scalar(0.999);  // else rounding makes it five substeps
        options_of_guard.max_retries = retries;
    }
    /// Substeps that the next frame takes, whatever becomes of it.
    Index spent(Guard& guard) {
        leak.steps = 0;
        ok = bool(guard.advance(state, frame));
        return leak.steps;
    }
    /// The longest step that does not leak any more is that of `level`.
    void mend(int level) {
        leak.above = 1.01 * static_cast<double>(frame) / static_cast<double>(plain << level);
    }

    Random random;
    System system;
    typename System::State state;
    typename Guard::Options options_of_guard;
    Leak leak{6};  // a fifth of the kinetic energy in a frame of 1/60 s
    Scalar frame = 0;
    bool ok = false;
};

}  // namespace

TEMPLATE_TEST_CASE("refinement: a scene that is stuck pays all retries once, then M/2 + 1 frames",
                   "[integrator]", float, double) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        for (const int retries : {0, 1, 3, 6}) {
            INFO("seed " << seed << ", retries " << retries);
            Flight<TestType> flight(seed, retries);
            typename Flight<TestType>::Guard guard(flight.system, flight.options_of_guard,
                                                   flight.leak);
            CHECK(flight.spent(guard) == plain * ((2 << retries) - 1));
            CHECK(flight.spent(guard) == plain);
            Index all = plain;
            Index most = plain;
            const Index round = Index(1) << retries;
            for (Index i = 1; i < round; ++i) {
                const Index spent = flight.spent(guard);
                CHECK_FALSE(flight.ok);
                all += spent;
                most = std::max(most, spent);
            }
            CHECK(2 * all == plain * round * (retries + 2));
            CHECK(most == plain << retries);
        }
    }
}

TEMPLATE_TEST_CASE("refinement: a stuck scene that level k mends goes on within 2^(k+1) frames",
                   "[integrator]", float, double) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Flight<TestType> flight(seed, 5);
        typename Flight<TestType>::Guard guard(flight.system, flight.options_of_guard, flight.leak);
        const Index stuck = 1 + flight.random.below(100);
        for (Index i = 0; i < stuck; ++i) {
            (void)flight.spent(guard);
            REQUIRE_FALSE(flight.ok);
        }
        const int level = static_cast<int>(seed % 6);
        INFO("seed " << seed << ", level " << level << ", stuck " << stuck);
        flight.mend(level);
        int frames = 1;
        Index spent = flight.spent(guard);
        for (; !flight.ok && frames < 1000; ++frames) spent = flight.spent(guard);
        CHECK(frames <= 2 << level);
        CHECK(spent >= plain << level);
        // It keeps what mended it, and has all its retries again.
        CHECK(flight.spent(guard) == spent);
        CHECK(flight.ok);
        flight.mend(5);
        CHECK(flight.spent(guard) == 2 * (plain << 5) - spent);
        CHECK(flight.ok);
    }
}

TEMPLATE_TEST_CASE(
    "refinement: an edit of the system renews the retries, one of the state does not",
    "[integrator]", float, double) {
    Flight<TestType> flight(3, 4);
    typename Flight<TestType>::Guard guard(flight.system, flight.options_of_guard, flight.leak);
    (void)flight.spent(guard);
    flight.state.v *= TestType(1.001);
    CHECK(flight.spent(guard) == plain);
    flight.system.set_stiffness(0, flight.system.springs().parameters[0].stiffness / 2);
    flight.mend(3);
    (void)flight.spent(guard);
    CHECK(flight.ok);
}

}  // namespace taut_test::refinement_test
