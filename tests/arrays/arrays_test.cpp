// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "arrays_scenes.hpp"

// check_step judges the arrays of a program as the library judges a SpringSystem of them.

namespace taut_test::arrays_test {

using taut::Cause;
using taut::Method;
using taut::StepLimit;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void check_same(const StepLimit<double>& ours, const StepLimit<double>& theirs) {
    CHECK(ours.certified == theirs.certified);
    CHECK(ours.refuted == theirs.refuted);
    CHECK(ours.cause == theirs.cause);
    CHECK(ours.admitted_growth == theirs.admitted_growth);
}

/// With every kind of damping, or none.
NetOptions damped(int kind) {
    NetOptions options;
    options.decades = 2;
    options.dampers = kind % 2 == 1;
    options.rayleigh = kind / 2 % 2 == 1;
    options.whole_dampers = kind / 4 % 2 == 1;
    return options;
}

/// The matrix of a step of x⁺ = x + f·(x − x⁻) + part·h²a on (x, x⁻), all in units of M^½x.
RealMatrix verlet_matrix(const Exact& e, Real f, Real h, Real part = 1) {
    const Index N = e.size();
    const RealMatrix K = e.scaled(0, part, 0, false), D = e.scaled(0, 0, part, false);
    const RealMatrix one = RealMatrix::Identity(N, N);
    RealMatrix A = RealMatrix::Zero(2 * N, 2 * N);
    A.topLeftCorner(N, N) = (1 + f) * one - h * h * K - h * D;
    A.topRightCorner(N, N) = h * D - f * one;
    A.bottomLeftCorner(N, N) = one;
    return A;
}

Real radius(const RealMatrix& A) { return general_eigenvalues(A).cwiseAbs().maxCoeff(); }

/// The largest h of 2(1 + f)M − 2hD − h²K ⪰ 0.
double verlet_limit(Exact e, Real f) {
    e.mass *= (1 + f) / 2;
    return definite_limit(e, 1, false);
}

/// An engine's position Verlet in springs of rest length 0, with dampers on (x − x⁻)/h.
/// @returns the largest coordinate on the way
double run_verlet(const Net& net, double h, int steps) {
    Eigen::MatrixXd x = net.x, before = x, a(net.dim, net.size());
    std::vector<char> pinned(net.mass.size());
    for (const int i : net.pins) pinned[std::size_t(i)] = 1;
    double largest = 0;
    for (int step = 0; step < steps && largest < 1e30; ++step) {
        a.setZero();
        for (std::size_t s = 0; s < net.ends.size(); ++s) {
            const auto [p, q] = net.ends[s];
            const Eigen::VectorXd d = x.col(q) - x.col(p);
            const Eigen::VectorXd f =
                net.stiffness[s] * d +
                net.whole_damping[s] / h * (d - before.col(q) + before.col(p));
            a.col(p) += f / net.mass[std::size_t(p)];
            a.col(q) -= f / net.mass[std::size_t(q)];
        }
        for (Index i = 0; i < net.size(); ++i) {
            const Eigen::VectorXd now = x.col(i);
            if (pinned[std::size_t(i)]) continue;
            x.col(i) += net.velocity_factor * (now - before.col(i)) + h * h * a.col(i);
            before.col(i) = now;
        }
        largest = std::max(largest, x.cwiseAbs().maxCoeff());
    }
    return largest;
}

}  // namespace

TEST_CASE("arrays: the answers of a SpringSystem", "[arrays]") {
    const double h = 0.1;
    int limited = 0, named = 0;
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        for (const bool single : {true, false}) {
            for (const int dim : {1, 2, 3}) {
                Random random(100 * seed + std::uint32_t(dim));
                NetOptions options = damped(int(seed) % 4);
                options.powers_of_two = true;
                const Net net = random_net(random, single, dim, options);
                INFO("seed " << seed << ", " << net.text());
                for (const Method method :
                     {Method::explicit_euler, Method::symplectic_euler, Method::velocity_verlet,
                      Method::implicit_euler, Method::energy_stable_euler}) {
                    const Answers theirs = system_answers(net, method, 3);
                    for (const Layout layout : {Layout::apart, Layout::records, Layout::inverses}) {
                        const auto ours = check_step(net, method, h, {}, layout);
                        check_same(ours.limit, theirs.any_pose);
                        CHECK(ours.safe == (h <= 0.95 * theirs.any_pose.certified));
                        CHECK(ours.substeps == theirs.any_pose.substeps(h).value_or(0));
                        if (ours.substeps > 1) ++limited;
                        const auto without = check_step(net, method, h, {}, layout, false);
                        check_same(without.limit, theirs.any_pose);
                        CHECK_FALSE(without.at_pose.has_value());
                        const bool judged = method != Method::energy_stable_euler;
                        REQUIRE(ours.at_pose.has_value() == judged);
                        if (!judged) continue;
                        check_same(ours.at_pose->limit, theirs.at_pose);
                        if (ours.at_pose->limit.cause != Cause::stiffness) continue;
                        REQUIRE(ours.at_pose->to_blame.size() <= theirs.springs.size());
                        for (std::size_t s = 0; s < ours.at_pose->to_blame.size(); ++s) {
                            const auto& spring = ours.at_pose->to_blame[s];
                            CHECK(spring.index == theirs.springs[s].index);
                            CHECK(spring.share == theirs.springs[s].share);
                            CHECK(spring.a == net.ends[std::size_t(spring.index)][0]);
                            CHECK(spring.b == net.ends[std::size_t(spring.index)][1]);
                            ++named;
                        }
                    }
                }
            }
        }
    }
    CHECK(limited > 100);
    CHECK(named > 100);
}

TEST_CASE("arrays: one number stands for all rows, whichever the field", "[arrays]") {
    const std::vector<int> ends = {0, 1, 1, 2, 2, 3};
    taut::SpringArrays<double, 1> rows, numbers;
    const std::vector<double> four(4, 4), half(3, 0.5), quarter(4, 0.25), stiffness(3, 70);
    rows.particles = numbers.particles = 4;
    rows.springs = numbers.springs = 3;
    rows.ends = numbers.ends = ends;
    rows.stiffness = stiffness;
    numbers.stiffness = 70;
    const auto same = [&] {
        const auto a = taut::check_step(rows, Method::symplectic_euler, 0.1);
        const auto b = taut::check_step(numbers, Method::symplectic_euler, 0.1);
        CHECK(a.limit.certified == b.limit.certified);
        return a.limit.certified;
    };
    rows.inverse_mass = quarter;
    numbers.inverse_mass = 0.25;
    const double undamped = same();
    rows.damping = rows.whole_damping = half;
    numbers.damping = numbers.whole_damping = 0.5;
    CHECK(same() < undamped);
    rows.inverse_mass = numbers.inverse_mass = {};
    rows.mass = four;
    numbers.mass = 4;
    CHECK(same() < undamped);
}

TEST_CASE("arrays: dampers of both kinds against dense eigenvalues", "[arrays]") {
    double worst = 1;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        for (const int dim : {1, 2, 3}) {
            Random random(seed + 1000);
            NetOptions options = damped(int(seed) % 8);
            options.particles = 6;
            options.springs = 12;
            Net net = random_net(random, false, dim, options);
            // Pulled, so that K is semi-definite and nothing but the step grows.
            if (seed % 2 == 0) net.x *= 50;
            if (seed % 2 == 1) std::fill(net.rest_length.begin(), net.rest_length.end(), 0.0);
            net.velocity_factor = seed % 5 == 0 ? 1 : random.uniform(0, 1);
            INFO("seed " << seed << ", " << net.text() << ", f = " << net.velocity_factor);
            const Exact e = exact_matrices(net);
            if (e.size() == 0) continue;
            const auto check = check_step(net, Method::position_verlet, 1e-3);
            const double truth = verlet_limit(e, net.velocity_factor);
            const double proved = check.at_pose->limit.certified;
            if (!std::isfinite(truth)) {
                CHECK(proved == infinity);
                continue;
            }
            CHECK(proved <= truth * (1 + 1e-12));
            CHECK(check.limit.certified <= truth * (1 + 1e-12));
            CHECK(check.limit.certified > 0);
            worst = std::min(worst, proved / truth);
            for (const double h : {proved, 0.7 * check.limit.certified}) {
                const Real f = net.velocity_factor;
                CHECK(radius(verlet_matrix(e, f, h)) <= 1 + 1e-6L);
                CHECK(radius(verlet_matrix(e, f, h, f)) <= 1 + 1e-6L);  // v⁺ = f·(v + ha)
            }
            CHECK(radius(verlet_matrix(e, net.velocity_factor, 1.01L * truth)) > 1 + 1e-6L);
        }
    }
    CHECK(worst > 0.6);
}

TEST_CASE("arrays: at any pose a damper is as strong as one along the spring", "[arrays]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed + 8000);
        NetOptions options;
        options.whole_dampers = true;
        Net net = random_net(random, seed % 2 == 0, 3, options);
        for (const Method method : {Method::symplectic_euler, Method::energy_stable_euler}) {
            Net axial = net;
            std::swap(axial.damping, axial.whole_damping);
            INFO("seed " << seed << ", " << taut::name(method));
            check_same(check_step(net, method, 1e-3).limit, check_step(axial, method, 1e-3).limit);
        }
    }
}

TEST_CASE("arrays: any pose is judged with dampers of both kinds", "[arrays]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed + 2000);
        NetOptions options = damped(4 + int(seed) % 4);
        options.particles = 6;
        options.springs = 10;
        Net net = random_net(random, false, 2 + int(seed % 2), options);
        net.velocity_factor = random.uniform(0, 1);
        INFO("seed " << seed << ", " << net.text());
        const double h = check_step(net, Method::position_verlet, 1e-3).limit.certified;
        REQUIRE(h > 0);
        for (int pose = 0; pose < 6; ++pose) {
            net.x = 4 * Eigen::MatrixXd::NullaryExpr(net.dim, net.size(),
                                                     [&] { return random.uniform(-1, 1); });
            const Exact e = exact_matrices(net);
            if (e.size() == 0) continue;
            Exact scaled = e;
            scaled.mass *= (1 + static_cast<Real>(net.velocity_factor)) / 2;
            CHECK(definite_margin(scaled, h) >= -1e-12L);
        }
    }
}

TEST_CASE("arrays: explicit Euler lives on dampers of the whole velocity", "[arrays]") {
    int proved = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        for (const bool single : {true, false}) {
            Random random(seed + 3000);
            NetOptions options;
            options.particles = 5;
            options.springs = 8;
            Net net = random_net(random, single, 3, options);
            net.x *= 50;
            net.rayleigh.mass_proportional = seed % 2 == 0 ? 0.5 : 0;
            for (double& c : net.whole_damping) c = random.uniform(5, 50);
            INFO("seed " << seed << ", " << net.text());
            const Exact e = exact_matrices(net);
            if (e.size() == 0) continue;
            const auto check = check_step(net, Method::explicit_euler, 1e-3);
            CHECK(check.limit.certified == 0);
            CHECK(check.limit.cause == Cause::one_pose_only);
            CHECK(check.to_blame.empty());
            const double h = check.at_pose->limit.certified;
            CHECK(h > 0);
            CHECK(h <= Multipliers(e).explicit_limit());
            if (h > 0) ++proved;
        }
    }
    CHECK(proved > 20);
}

TEST_CASE("arrays: the substeps are enough for an engine's position Verlet", "[arrays]") {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        for (const int dim : {1, 2, 3}) {
            Random random(seed + 4000);
            NetOptions options;
            options.decades = 2;
            options.zero_length = true;
            options.whole_dampers = seed % 2 == 0;
            Net net = random_net(random, false, dim, options);
            net.pins = {0};  // nothing drifts
            net.x.col(0).setZero();
            net.velocity_factor = seed % 3 == 0 ? random.uniform(0.5, 1) : 1;
            INFO("seed " << seed << ", " << net.text());
            const double frame = 0.1;
            const auto check = check_step(net, Method::position_verlet, frame);
            REQUIRE(check.substeps > 0);
            CHECK(run_verlet(net, frame / double(check.substeps), 5000) < 1e4);
            const double truth = verlet_limit(exact_matrices(net), net.velocity_factor);
            CHECK(run_verlet(net, 1.02 * truth, 5000) > 1e20);
        }
    }
}

TEST_CASE("arrays: what sets the limit is named", "[arrays]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Random random(seed + 5000);
        NetOptions options;
        options.particles = 12;
        options.springs = 24;
        Net net = random_net(random, seed % 2 == 0, 3, options);
        net.pins.clear();
        const std::size_t culprit = static_cast<std::size_t>(random.below(net.springs()));
        INFO("seed " << seed << ", spring " << culprit);
        const auto first = [&] {
            const auto check = check_step(net, Method::position_verlet, 1e-3);
            REQUIRE(check.to_blame.size() == 3);
            REQUIRE(check.at_pose->to_blame.size() == 3);
            CHECK(check.to_blame[0].share >= check.to_blame[1].share);
            CHECK(check.at_pose->to_blame[0].index == Index(culprit));
            return check.to_blame[0].index;
        };
        const double k = net.stiffness[culprit];
        net.stiffness[culprit] = 1e6;
        CHECK(first() == Index(culprit));
        net.stiffness[culprit] = k;
        net.damping[culprit] = 1e5;
        CHECK(first() == Index(culprit));
        net.damping[culprit] = 0;
        net.whole_damping[culprit] = 1e5;
        CHECK(first() == Index(culprit));
        taut::StepCheckOptions none;
        none.to_blame = 0;
        CHECK(check_step(net, Method::position_verlet, 1e-3, none).to_blame.empty());
    }
}

TEST_CASE("arrays: safety and frame", "[arrays]") {
    Random random(6000);
    const Net net = random_net(random, true, 3, {});
    const auto limit = check_step(net, Method::symplectic_euler, 1).limit;
    const double certified = limit.certified;
    for (const double safety : {0.5, 0.95, 1.0}) {
        taut::StepCheckOptions options;
        options.safety = safety;
        CHECK(check_step(net, Method::symplectic_euler, 0.999 * safety * certified, options).safe);
        CHECK_FALSE(
            check_step(net, Method::symplectic_euler, 1.001 * safety * certified, options).safe);
        options.frame = 1.0 / 60;
        const auto substeps = check_step(net, Method::symplectic_euler, 1e-9, options).substeps;
        CHECK(substeps == limit.substeps(1.0 / 60, safety));
    }
    CHECK(check_step(net, Method::energy_stable_euler, 1e-3).limit.certified > 0);
    CHECK_FALSE(check_step(net, Method::energy_stable_euler, 1e-3).at_pose.has_value());
    CHECK(check_step(net, Method::implicit_euler, 1e3).safe);
    Net empty;
    empty.x.resize(3, 0);
    const auto nothing = check_step(empty, Method::symplectic_euler, 1);
    CHECK(nothing.safe);
    CHECK(nothing.limit.cause == Cause::nothing_to_limit);
}

TEST_CASE("arrays: wrong numbers are named", "[arrays][bad_input]") {
    Random random(7000);
    NetOptions plain;
    plain.springs = 6;
    Net good = random_net(random, false, 2, plain);
    good.pins = {1};
    const auto refusal = [&](const auto& spoil, Method method = Method::symplectic_euler) {
        Net net = good;
        spoil(net);
        return message_of([&] { (void)check_step(net, method, 1e-3); });
    };
    const auto says = [](const std::string& message, const char* part) {
        INFO(message);
        CHECK(message.find("check_step: ") != std::string::npos);
        CHECK(message.find(part) != std::string::npos);
    };
    const double nan = std::nan("");
    says(refusal([](Net& n) { n.ends[4][1] = 9; }), "spring 4 joins particle 9; there are 9");
    says(refusal([](Net& n) { n.ends[4][0] = -1; }), "spring 4 joins particle -1");
    says(refusal([](Net& n) { n.ends[2] = {3, 3}; }), "both ends of spring 2 are particle 3");
    says(refusal([](Net& n) { n.mass[5] = -2; }), "the mass of particle 5 is -2");
    says(refusal([](Net& n) { n.mass[5] = 0; }), "the mass of particle 5 is 0");
    says(refusal([](Net& n) { n.mass[5] = infinity; }), "the mass of particle 5 is inf");
    says(refusal([](Net& n) { n.pins = {0, 12}; }), "pin 1 holds particle 12");
    says(refusal([](Net& n) { n.stiffness[3] = -1; }), "the stiffness of spring 3 is -1");
    says(refusal([&](Net& n) { n.stiffness[3] = nan; }), "the stiffness of spring 3 is nan");
    says(refusal([](Net& n) { n.rest_length[0] = -0.5; }), "the rest length of spring 0 is -0.5");
    says(refusal([](Net& n) { n.damping[1] = infinity; }), "the damping of spring 1 is inf");
    says(refusal([](Net& n) { n.whole_damping[1] = -3; }), "the whole damping of spring 1 is -3");
    says(refusal([&](Net& n) { n.x(1, 7) = nan; }), "the position of particle 7 is not finite");
    says(refusal([](Net& n) { n.rayleigh.mass_proportional = -1; }), "mass_proportional is -1");
    says(refusal([](Net& n) { n.velocity_factor = 1.5; }), "velocity_factor is 1.5");
    says(refusal([](Net& n) { n.velocity_factor = 0.5; }, Method::velocity_verlet),
         "with velocity_verlet it must be 1");
    says(refusal([](Net& n) { n.stiffness[3] = 1e-200; }), "the stiffness of spring 3 is 1e-200");
    says(refusal([](Net& n) { n.whole_damping[3] = 1e200; }),
         "whole damping of spring 3 is 1e+200");
    CHECK(refusal([](Net& n) { n.mass[1] = 0; }).empty());  // pinned
    says(refusal([](Net& n) { n.stiffness.pop_back(); }),
         "stiffness has 5 rows; there are 6 springs");
    says(refusal([](Net& n) { n.stiffness.clear(); }), "stiffness has 0 rows");
    says(refusal([](Net& n) { n.rest_length.pop_back(); }), "rest_length has 5 rows");
    says(refusal([](Net& n) { n.whole_damping.pop_back(); }), "whole_damping has 5 rows");
    const std::vector<double> eight(8, 1);
    for (auto field :
         {&taut::SpringArrays<double, 1>::mass, &taut::SpringArrays<double, 1>::inverse_mass}) {
        taut::SpringArrays<double, 1> arrays;
        arrays.particles = 9;
        arrays.*field = eight;
        says(message_of([&] { (void)taut::check_step(arrays, Method::symplectic_euler, 1e-3); }),
             "mass has 8 rows; there are 9 particles");
    }
    for (const double h : {0.0, -1.0, infinity, nan}) {
        says(message_of([&] { (void)check_step(good, Method::symplectic_euler, h); }), "h is ");
        taut::StepCheckOptions options;
        options.frame = h == 0 ? -1 : h;
        says(message_of([&] { (void)check_step(good, Method::symplectic_euler, 1e-3, options); }),
             "frame is ");
        options = {};
        options.safety = h;
        says(message_of([&] { (void)check_step(good, Method::symplectic_euler, 1e-3, options); }),
             "safety is ");
    }
    good.mass[3] = -2;
    const auto message = message_of(
        [&] { (void)check_step(good, Method::symplectic_euler, 1e-3, {}, Layout::inverses); });
    says(message, "the inverse mass of particle 3 is -0.5");
}

}  // namespace taut_test::arrays_test
