// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A referee of contact in one step, from the text of docs/theory/contact.md [T39] alone: of what a
// particle has come to, it asks in long double whether forces that the theorem allows bring it
// there, and whether their work is what is booked.

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "particle_referee.hpp"

namespace taut_test::particle_solve_test {

namespace {

constexpr Real roundings = 64;

using Column = Eigen::Matrix<Real, 4, 1>;

/// The least |Σ yᵢcᵢ − b| of 0 ≤ yᵢ ≤ mostᵢ, by sets of the yᵢ that are at no bound.
/// @param y  where to begin, at bounds   @param enough  what is not looked at
Real bounded_least_squares(const std::vector<Column>& c, const std::vector<Real>& most,
                           const Column& b, std::vector<Real> y, Real enough) {
    const std::size_t size = c.size();
    std::vector<bool> open(size, false);
    const Real tiny = 1e4L * std::numeric_limits<Real>::epsilon();
    const auto rest = [&] {
        Column r = b;
        for (std::size_t i = 0; i < size; ++i) r -= y[i] * c[i];
        return r;
    };
    for (int round = 0; round < 200; ++round) {
        const Column r = rest();
        std::size_t best = size;
        Real steepest = (std::max)(enough / 100, 10 * tiny * r.norm());
        for (std::size_t i = 0; i < size; ++i) {
            const Real slope = c[i].dot(r) / c[i].norm();
            if (open[i] || !((y[i] > 0 ? -slope : slope) > steepest)) continue;
            steepest = (std::abs)(slope);
            best = i;
        }
        if (best == size) break;
        open[best] = true;
        for (bool again = true; again;) {
            // The step to the least of the open ones, by orthogonal columns.
            std::vector<std::size_t> at;
            std::vector<Column> q, of;
            Column left = rest();
            for (std::size_t i = 0; i < size; ++i) {
                if (!open[i]) continue;
                Column unit = c[i] / c[i].norm();
                for (const Column& other : q) unit -= other.dot(unit) * other;
                if (unit.norm() > tiny) {
                    at.push_back(i);
                    unit.normalize();
                    for (const Column& other : q) unit -= other.dot(unit) * other;
                    q.push_back(unit.normalized());
                } else {
                    open[i] = false;
                }
            }
            std::vector<Real> step(size, 0);
            for (std::size_t k = at.size(); k-- > 0;) {
                // c of at[k] alone has a share along q[k] once the later ones are taken off.
                Real along = q[k].dot(left);
                for (std::size_t l = k + 1; l < at.size(); ++l)
                    along -= q[k].dot(c[at[l]]) * step[at[l]];
                step[at[k]] = along / q[k].dot(c[at[k]]);
            }
            Real share = 1;
            std::size_t bound = size;
            for (const std::size_t i : at) {
                const Real to = y[i] + step[i];
                const Real may = to < 0         ? -y[i] / step[i]
                                 : to > most[i] ? (most[i] - y[i]) / step[i]
                                                : Real(1);
                if (may < share || (may <= share && bound == size && may < 1)) {
                    share = may;
                    bound = i;
                }
            }
            for (const std::size_t i : at) y[i] += share * step[i];
            again = bound < size;
            if (!again) break;
            open[bound] = false;
            y[bound] = step[bound] < 0 ? Real(0) : most[bound];
        }
    }
    return rest().norm();
}

/// How much T + Σφ + ½m|v⁺ − v*|² rises beyond the work, in roundings. Every pair counts as deep
/// as its plane says, p − z, or less: so much the theorem promises.
Real gained(const Step& step) {
    const Real size = step.size(), unit = step.pairs[0].unit;
    Real apart = 0, rubs = 0;
    Real gain = (step.after.squaredNorm() - step.before.squaredNorm() +
                 (step.after - step.before).squaredNorm()) /
                    2 -
                step.work;
    Real rounding = size * size;
    for (const auto& pair : step.pairs) {
        const Real plane = pair.begin - pair.h * pair.out(step.after);
        const Real end = (std::min)(pair.depth(step.end()), plane);
        const Real kicks = pair.kick(end) + pair.kick(pair.begin);
        gain += pair.energy(end) - pair.energy(pair.begin);
        rounding += kicks * size;
        // Where a place decides, it is as it is rounded.
        const Real unsure = 8 * unit * pair.reach;
        if (std::abs(end) < unsure || std::abs(end - pair.begin) < unsure)
            rounding += kicks * unsure / unit / pair.h;
        const Real beside = (pair.speed - step.pairs[0].speed).norm();
        apart = (std::max)(apart, beside + unit * pair.reach / pair.h);
        if (pair.friction > 0) rubs = 1 / std::sqrt(unit);
    }
    if (step.pairs.size() > 1) rounding += step.magnified() * apart * size + rubs * size * size;
    return gain / (unit * rounding);
}

/// How far the step is from any that forces of the theorem make, in roundings: of each pair a share
/// of φ′, all of it where it goes in, less ½hκ n′n′ᵀ(v⁺ − ū), and friction against its sliding; or
/// none where it ends no deeper. Of one pair, none pulls.
Real unexplained(const Step& step) {
    const Real size = step.size(), unit = step.pairs[0].unit;
    const bool alone = step.pairs.size() == 1;
    const Wide &frame = step.pairs[0].speed, change = step.after - step.before;
    Real scale = size / 100;  // of what forces work against
    for (const auto& pair : step.pairs) scale = (std::max)(scale, pair.speed.norm());
    // Work does not tell bodies apart that move as one but for rounding.
    Real least = scale;
    for (const auto& a : step.pairs) {
        for (const auto& b : step.pairs) {
            const Real apart = (a.speed - b.speed).norm();
            if (apart > 0) least = (std::min)(least, apart);
        }
    }
    if (least < Real(1e-4) * scale) scale = std::numeric_limits<Real>::infinity();
    const auto row = [&](const Wide& f, const Wide& u) {
        Column column;
        column << f, (u - frame).dot(f) / scale;
        return column;
    };
    Column rest;
    rest << change, (step.work - frame.dot(change)) / scale;
    std::vector<Column> forces;
    std::vector<Real> most, none;  // where none acts, if that is a bound
    Real rounding = (step.magnified() + step.pairs[0].block) * size;
    for (const auto& pair : step.pairs) {
        const Real out = pair.out(step.after), kick = pair.kick(pair.begin);
        const Real brake = pair.block * out;
        Real low = kick - brake, high = low;
        if (out >= -16 * unit * step.magnified() * size) {
            high = (std::max)(high, Real(0));
            low = alone && !(step.in_registers && pair.gently()) ? Real(0)
                                                                 : -(std::max)(brake, Real(0));
        } else if (pair.depth(step.end()) <=
                   (std::max)(pair.begin, Real(0)) + 8 * unit * pair.reach) {
            low = alone && pair.begin > 0 ? low : Real(0);
        }
        rest -= row(low * pair.normal, pair.speed);
        if (high > low) {
            forces.push_back(row((high - low) * pair.normal, pair.speed));
            most.push_back(1);
            none.push_back(high > 0 ? Real(0) : Real(1));
        }
        rounding += kick;
        Wide along = pair.along(step.after);
        // What sticks has no way but the one that it would have gone.
        if (along.norm() <= 4 * unit * size) along = pair.along(step.before);
        // Several bodies that it began inside may hold it.
        if ((!(pair.friction > 0) && !pair.gently()) || !(along.norm() > 0)) continue;
        forces.push_back(row(-size / along.norm() * along, pair.speed));
        most.push_back(std::numeric_limits<Real>::infinity());
        none.push_back(0);
        rounding += size * (std::min)(size / along.norm(), 1 / unit);
    }
    // Any forces will do: the search may end early where bodies are almost the same.
    const std::vector<Real> least_of_all(most.size(), Real(0));
    const Real left =
        (std::min)(bounded_least_squares(forces, most, rest, none, unit * size),
                   bounded_least_squares(forces, most, rest, least_of_all, unit * size));
    return left / (unit * rounding);
}

/// How far one pair alone is from Coulomb's law, in roundings.
Real off_coulomb(const Step& step) {
    const PairReferee& pair = step.pairs[0];
    const Wide change = step.after - step.before;
    const Real push = pair.normal.dot(change), size = step.size();
    const Wide rubbed = change - push * pair.normal, along = pair.along(step.after);
    const Real friction = pair.gently() ? Real(0) : pair.friction;
    const Real most = friction * (std::max)(push, Real(0));
    Real off = rubbed.norm() - most, rounding = (1 + pair.block) * size * (1 + friction);
    if (along.norm() > 2 * std::sqrt(pair.unit) * size)  // it slides
    {
        off = (rubbed + most / along.norm() * along).norm();
        rounding += most * size / along.norm();
    }
    return off / (pair.unit * rounding);
}

/// How far two steps of the same particle are apart, in roundings.
Real apart(const Step& a, const Step& b) {
    Real rounding = a.magnified() * a.size();
    for (const auto& pair : a.pairs) rounding += pair.kick(pair.begin);
    return (a.after - b.after).norm() / (a.pairs[0].unit * rounding);
}

void check(const Step& step) {
    CHECK(step.follows);
    for (const auto& pair : step.pairs) CHECK(pair.carries);
    if (!step.touches) {
        CHECK((step.after == step.before && step.work == 0));
        for (const auto& pair : step.pairs) {
            CHECK(pair.begin <= 0);
            CHECK(pair.depth(step.end()) <= 8 * pair.unit * pair.reach);
        }
        return;
    }
    CHECK(gained(step) < roundings);
    CHECK(unexplained(step) < roundings * static_cast<Real>(step.pairs.size()));
    if (step.pairs.size() == 1) CHECK(off_coulomb(step) < roundings);
}

}  // namespace

TEMPLATE_TEST_CASE("particle solve: forces that the theorem allows explain every step", "[contact]",
                   (Case<float, 1>), (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    Random random(39);
    int touched = 0;
    for (int scene = 0; scene < 3000; ++scene) {
        const ParticleOptions options{scene % 2 > 0, scene % 3 == 0, 1 + random.below(6)};
        const auto steps = solved_steps<typename TestType::Scalar, TestType::Dim>(random, options);
        touched += steps[0].touches;
        CAPTURE(scene, options.bodies, options.stiff, options.flush);
        check(steps[0]);
        // The order of bodies is of no account.
        CHECK(steps[0].touches == steps[1].touches);
        CHECK(apart(steps[0], steps[1]) < roundings);
    }
    CHECK(touched > 2000);
}

TEMPLATE_TEST_CASE("particle solve: one body pushes so in registers, too", "[contact]",
                   (Case<float, 1>), (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    Random random(40);
    int touched = 0, gently = 0;
    for (int scene = 0; scene < 2000; ++scene) {
        for (const auto& [pushed, solved] :
             pushed_steps<typename TestType::Scalar, TestType::Dim>(random, scene % 2 > 0)) {
            CAPTURE(scene);
            check(pushed);
            check(solved);
            const PairReferee& pair = pushed.pairs[0];
            touched += pushed.touches;
            if (!pair.gently()) {
                // There friction is by a force that is rounded, and what sticks has a finite drag.
                const Real rubs = pair.friction > 0 ? 1 / std::sqrt(pair.unit) : Real(0);
                const Real more = 2 * rubs + 8 * pair.friction * pair.block;
                CHECK(apart(pushed, solved) < roundings + more);
                continue;
            }
            ++gently;
            // As fast as it is asked to, or as it is with no force but the brake.
            const Real asked = (std::min)(pair.begin / (2 * pair.h), pair.push_out);
            const Real braked = pair.out(pushed.before) / (1 + pair.block);
            CHECK(pair.out(pushed.after) <=
                  (std::max)(asked, braked) + roundings * pair.unit * pushed.size());
        }
    }
    CHECK(touched > 2000);
    CHECK(gently > 500);
}

}  // namespace taut_test::particle_solve_test
