// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// The account by which a guard judges, on frames made by hand.
#include <cmath>
#include <taut/integrator/detail/energy_account.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::energy_account_test {

using taut::Method;
using taut::integrator_detail::EnergyAccount;
using taut::integrator_detail::EnergyBooks;
using taut::integrator_detail::EnergyTerms;

namespace {

constexpr double frame = 0.01;  // s
constexpr EnergyTerms tight{0.01, 0, 1, 1};

EnergyBooks books(double kinetic, double gravity = 0, double power = 0) {
    EnergyBooks b;
    b.kinetic = kinetic;
    b.gravity = gravity;
    b.power = power;
    return b;
}

/// An account that has just been opened with `start`.
EnergyAccount opened(const EnergyBooks& start, const EnergyTerms& terms = tight) {
    EnergyAccount account;
    account.open(start, terms);
    return account;
}

/// From `start` to `end` by steps that keep H.
EnergyAccount::Frame step(const EnergyBooks& start, const EnergyBooks& end, double work = 0) {
    return {start, end, Method::implicit_euler, frame, frame, work, 0, 0, 0};
}

/// Settles the frames next(energy) until one is refused; energy ends as that of the last one.
/// @returns how many were settled, `most` at the most
template <class Next>
int settle_frames(EnergyAccount& account, const EnergyTerms& terms, double& energy, int most,
                  Next&& next) {
    int frames = 0;
    for (; frames < most; ++frames) {
        const EnergyAccount::Frame f = next(energy);
        if (!account.judge(f, terms).admitted) break;
        account.settle(f, terms);
        energy = f.end.owned();
    }
    return frames;
}

}  // namespace

TEST_CASE("energy account: a rise is what no work explains, relative to what moved",
          "[integrator]") {
    const EnergyAccount account = opened(books(10, 20));
    // 10 J fall by 5 J of gravity and are pushed by 3 J.
    const auto exact = account.judge(step(books(10, 20), books(18, 15), 3), tight);
    CHECK(exact.admitted);
    CHECK_THAT(exact.rise, WithinAbs(0, 1e-12));
    CHECK_THAT(exact.allowed, WithinRel(0.01 * (10 + 5 + 3), 1e-12));
    // What rises in gravity or is lost to a brake is no scale of its own.
    const auto up = account.judge(step(books(10, 0), books(4, 5), -1), tight);
    CHECK_THAT(up.allowed, WithinRel(0.01 * (10 + 1), 1e-12));
    CHECK(account.judge(step(books(10), books(10.09)), tight).admitted);
    CHECK_FALSE(account.judge(step(books(10), books(10.11)), tight).admitted);
    CHECK_FALSE(account.judge(step(books(10), books(10.5), 0.3), tight).admitted);
    CHECK(account.judge(step(books(10), books(10.5), 0.45), tight).admitted);
}

TEST_CASE("energy account: what was admitted stays a debt, however the rise is cut into frames",
          "[integrator]") {
    Random random(3);
    for (int run = 0; run < 50; ++run) {
        EnergyAccount account = opened(books(10));
        double energy = 10;
        const int frames = settle_frames(account, tight, energy, 10000, [&](double from) {
            // Falls and rises; the work of a pump explains a part of them.
            const double work = random.uniform(-0.01, 0.01);
            return step(books(from), books(from + work + random.uniform(0, 0.002)), work);
        });
        // 1 % of some 10 J at 0.001 J a frame, and no more.
        CHECK(frames > 50);
        CHECK(frames < 200);
    }
}

TEST_CASE("energy account: a fall pays the debt, and no more than the debt", "[integrator]") {
    EnergyAccount account = opened(books(10));
    const auto settle = [&](double from, double to) {
        const auto f = step(books(from), books(to));
        REQUIRE(account.judge(f, tight).admitted);
        account.settle(f, tight);
    };
    settle(10, 10.08);
    CHECK_FALSE(account.judge(step(books(10.08), books(10.13)), tight).admitted);
    settle(10.08, 10);
    settle(10, 10.08);
    settle(10.08, 9);
    // The account has fallen to 9 J; it is not what it was at 10 J.
    CHECK_FALSE(account.judge(step(books(9), books(9.2)), tight).admitted);
}

TEST_CASE("energy account: the drift grants e^(rt) and no more", "[integrator]") {
    for (const double r : {0.005, 0.1}) {
        const EnergyTerms terms{0.01, r, 1, 1};
        for (const double rate : {0.8 * r, 1.3 * r}) {
            EnergyAccount account = opened(books(10), terms);
            double energy = 10;
            const auto most = static_cast<int>(2 / (r * frame));
            const int frames = settle_frames(account, terms, energy, most, [&](double from) {
                return step(books(from), books(from * (1 + rate * frame)));
            });
            CHECK((frames == most) == (rate < r));
        }
    }
}

TEST_CASE("energy account: gains by a change of h are bounded by the swing", "[integrator]") {
    // A state whose power changes sign between two steps: each change of h lifts what is kept, so
    // that every frame is exact by the first debt while H grows by 2 % each.
    const EnergyTerms terms{0.01, 0, 3, 2};
    EnergyAccount account = opened(books(1), terms);
    double energy = 1;
    (void)settle_frames(account, terms, energy, 1000, [](double from) {
        const double to = 1.02 * from;
        const double h = 0.1;
        // H + ½h·power is the same at both ends.
        EnergyAccount::Frame f = step(books(from, 0, 2 * (to - from) / h), books(to));
        f.method = Method::symplectic_euler;
        f.h = h;
        return f;
    });
    CHECK(energy > 2.5);
    CHECK(energy < 3.1);
}

TEST_CASE("energy account: a violent past is forgotten as a scale", "[integrator]") {
    EnergyAccount account = opened(books(1000));
    const auto crash = step(books(1000), books(1));
    account.settle(crash, tight);
    const double after = account.judge(step(books(1), books(1)), tight).allowed;
    CHECK(after > 5);
    for (int i = 0; i < 100 * 100; ++i) account.settle(step(books(1), books(1)), tight);
    CHECK_THAT(account.judge(step(books(1), books(1)), tight).allowed, WithinRel(0.01, 1e-9));
}

TEST_CASE("energy account: work that no resolved force did counts as a rise", "[integrator]") {
    const EnergyAccount account = opened(books(10));
    auto f = step(books(10), books(12), 2);
    CHECK(account.judge(f, tight).admitted);
    f.unresolved = 0.5;
    const auto verdict = account.judge(f, tight);
    CHECK_FALSE(verdict.admitted);
    CHECK_THAT(verdict.rise, WithinAbs(0.5, 1e-12));
    // And it sets no scale: a force that explodes would excuse itself.
    f = step(books(10), books(1000), 990);
    CHECK_THAT(account.judge(f, tight).allowed, WithinRel(0.01 * (10 + 990), 1e-12));
    f.in_doubt = 990;
    CHECK_THAT(account.judge(f, tight).allowed, WithinRel(0.01 * 10, 1e-12));
}

TEST_CASE("energy account: what brakes throw back counts when it grows, not while it stays",
          "[integrator]") {
    EnergyAccount account = opened(books(10));
    const auto turn = [&](double work, double thrown) {
        auto f = step(books(10), books(10 + work), work);
        f.thrown = thrown;
        return f;
    };
    Random random(4);
    for (int i = 0; i < 10000; ++i) {
        const auto f = turn(0, random.uniform(0, 0.05));
        const auto verdict = account.judge(f, tight);
        REQUIRE(verdict.admitted);
        CHECK_THAT(verdict.rise, WithinAbs(f.thrown, 1e-9));
        account.settle(f, tight);
    }
    // A drag that explodes calls its gain work.
    const auto verdict = account.judge(turn(2, 2.1), tight);
    CHECK_FALSE(verdict.admitted);
    CHECK_THAT(verdict.rise, WithinAbs(2.1, 1e-9));
    CHECK(verdict.in_doubt > 2);
}

TEST_CASE("energy account: an edit keeps the debt, and moves the grant with E", "[integrator]") {
    const EnergyTerms terms{0.01, 0.003, 3, 2};
    EnergyAccount account = opened(books(10), terms);
    const auto gained = step(books(10), books(10.08));
    account.settle(gained, terms);
    // Nudges renew nothing.
    for (int i = 0; i < 1000; ++i) account.edit(books(10.08), books(10.08), terms);
    CHECK_FALSE(account.judge(step(books(10.08), books(10.13)), terms).admitted);
    // Nearly all is taken out: what is left may swing, and be judged by what it owns now.
    account.edit(books(10.08), books(0.01), terms);
    const auto swing = [&](double to) {
        EnergyAccount::Frame f = step(books(0.01), books(to));
        f.method = Method::symplectic_euler;
        f.start.power = 2 * (to - 0.01) / f.h;  // as kept energy counts it, nothing is gained
        for (int i = 0; i < 20000; ++i) account.settle(step(books(0.01), books(0.01)), terms);
        return account.judge(f, terms).admitted;
    };
    CHECK(swing(0.029));
    CHECK_FALSE(swing(0.04));
}

TEST_CASE("energy account: an edit that adds no energy renews no swing, and takes its lag along",
          "[integrator]") {
    const EnergyTerms terms{0.01, 0, 3, 2};
    const auto swing = [](double from, double to) {
        // As kept energy counts it, nothing is gained.
        EnergyAccount::Frame f = step(books(from, 0, 2 * (to - from) / frame), books(to));
        f.method = Method::symplectic_euler;
        return f;
    };
    EnergyAccount swung = opened(books(1), terms);
    swung.settle(swing(1, 2.9), terms);
    swung.edit(books(2.9), books(2.9), terms);
    CHECK(swung.judge(swing(2.9, 3), terms).admitted);
    CHECK_FALSE(swung.judge(swing(2.9, 4), terms).admitted);

    // 10 J of the kept energy are what gravity did in half a step; then all velocities are turned.
    EnergyAccount falling = opened(books(10), terms);
    EnergyAccount::Frame fall = swing(10, 10);
    fall.end.fall_power = 2 * 10 / frame;
    falling.settle(fall, terms);
    falling.edit(fall.end, books(10), terms);
    CHECK(falling.judge(swing(10, 10), terms).admitted);
    CHECK_FALSE(falling.judge(swing(10, 12), terms).admitted);
}

}  // namespace taut_test::energy_account_test
