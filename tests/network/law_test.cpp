// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <string>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/step/spring_table.hpp>
#include <utility>

#include "../extend/stiffening.hpp"
#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/scene.hpp"
#include "../support/tolerance.hpp"

// What every law promises, and Hooke's spring and the string by hand. Buckling: buckling_test.cpp.

namespace taut_test::law_test {

using taut::Hookean;

namespace {

template <class Law>
using Parameters = typename Law::template Parameters<double>;
template <class Law>
using Fields = std::vector<std::pair<std::string, double Parameters<Law>::*>>;

Fields<Hookean> fields(Hookean) { return {{"stiffness", &Parameters<Hookean>::stiffness}}; }
Fields<TensionOnly> fields(TensionOnly) { return fields(Hookean{}); }
Fields<Buckling> fields(Buckling) {
    using P = Parameters<Buckling>;
    return {{"stiffness", &P::stiffness}, {"bending", &P::bending}, {"onset", &P::onset}};
}
Fields<Glue> fields(Glue) {
    using P = Parameters<Glue>;
    return {{"stiffness", &P::stiffness}, {"width", &P::width}};
}
Fields<Stiffening> fields(Stiffening) {
    using P = Parameters<Stiffening>;
    return {{"stiffness", &P::stiffness}, {"more", &P::more}, {"width", &P::width}};
}

/// A spring of the law with a length, m.
template <class Law, class Scalar>
struct Drawn {
    typename Law::template Parameters<Scalar> p;
    Scalar L, l;

    explicit Drawn(Random& random)
        : p(draw_parameters<Scalar>(random, Law{})),
          L(static_cast<Scalar>(random.uniform(0.2, 1.5))),
          l(static_cast<Scalar>(random.uniform(0.02, 1.8))) {}
    Scalar tension(Scalar at) const { return Law::tension(p, L, at); }
    Scalar slope(Scalar at) const { return Law::tension_slope(p, L, at); }
    Scalar energy(Scalar at) const { return Law::energy(p, L, at); }
    Scalar bound() const { return Law::stiffness_bound(p, L); }
};

template <class Law, class Scalar>
void check_derivatives(std::uint32_t seed) {
    Random random(seed);
    const Scalar h(1e-5);
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(seed, trial);
        const Drawn<Law, Scalar> s(random);
        const Scalar l = s.l;
        const auto near = [&](Scalar a, Scalar b, double most) {
            CHECK_THAT(static_cast<double>(a - b),
                       WithinAbs(0, most * static_cast<double>(s.bound())));
        };
        near((s.energy(l + h) - s.energy(l - h)) / (2 * h), s.tension(l), 1e-5);
        const auto jumps = [&](Scalar at) {
            return std::abs(s.slope(at) - s.slope(l)) > s.bound() / 1000;
        };
        if (jumps(l + 2 * h) || jumps(l - 2 * h)) continue;  // a kink
        near((s.energy(l + h) - s.energy(l - h)) / (2 * h), s.tension(l), 1e-6);
        near((s.tension(l + h) - s.tension(l - h)) / (2 * h), s.slope(l), 1e-6);
    }
}

template <class Law>
void check_bound_and_shape(std::uint32_t seed) {
    Random random(seed);
    bool pushes = false;
    bool falls = false;
    for (int trial = 0; trial < 500; ++trial) {
        CAPTURE(seed, trial);
        Drawn<Law, double> s(random);
        s.L = trial % 5 == 0 ? 0 : random.uniform(0, 1.5);
        const double l = trial % 3 == 0 ? random.uniform(1e-6, 1e-3) : random.uniform(0.01, 20);
        const double most = s.bound() * (1 + Tolerance<double>::rounding);
        CHECK(s.slope(l) <= most);
        CHECK(s.tension(l) / l <= most);
        pushes = pushes || s.tension(l) < 0;
        falls = falls || s.slope(l) < 0;
        CHECK(s.tension(s.L) == 0);
        CHECK(s.energy(s.L) == 0);
    }
    // The energy is convex in the positions where it does neither.
    CHECK(Law::convex == !(pushes || falls));
    CHECK(taut::network_detail::is_monotone_v<Law> == !falls);
}

template <class Law>
void check_slope_range(std::uint32_t seed) {
    Random random(seed);
    for (int trial = 0; trial < 200; ++trial) {
        CAPTURE(seed, trial);
        const Drawn<Law, double> s(random);
        const double low = s.l;
        const double high = trial % 4 == 0 && low < s.L ? s.L : low + random.uniform(0, 1);
        const auto [least, most] = taut::network_detail::slope_range<Law>(s.p, s.L, low, high);
        const double rounding = 1e-12 * s.bound();
        double below = least, above = most;  // by how much the samples stay within
        for (int i = 0; i <= 400; ++i) {
            const double slope = s.slope(std::min(high, low + (high - low) * i / 400));
            below = std::min(below, slope);
            above = std::max(above, slope);
        }
        CHECK(below >= least - rounding);
        CHECK(above <= most + rounding);
        CHECK(most <= s.bound() + rounding);
    }
}

/// Of registers it is what it is of numbers.
template <class Law, class Scalar>
void check_registers(std::uint32_t seed) {
    using Register = taut::step_detail::VectorRegister<Scalar>;
    Random random(seed);
    for (int trial = 0; trial < 100; ++trial) {
        CAPTURE(seed, trial);
        const Drawn<Law, Scalar> s(random);
        Scalar lengths[Register::width], tensions[Register::width], slopes[Register::width];
        for (Scalar& l : lengths) l = static_cast<Scalar>(random.uniform(0, 3));
        lengths[0] = s.L;
        const auto p = s.p.template cast<Register>();
        const auto l = Register::load(lengths);
        Law::tension(p, Register(s.L), l).store(tensions);
        Law::tension_slope(p, Register(s.L), l).store(slopes);
        for (int lane = 0; lane < Register::width; ++lane) {
            const auto near = [&](Scalar a, Scalar b, Scalar scale) {
                const double most = Tolerance<Scalar>::rounding * static_cast<double>(scale);
                CHECK_THAT(static_cast<double>(a - b), WithinAbs(0, most));
            };
            const Scalar length = lengths[lane];
            near(tensions[lane], s.tension(length), s.bound() * std::max(s.L, length));
            near(slopes[lane], s.slope(length), s.bound());
        }
    }
}

template <class Law>
void check_parameters(std::uint32_t seed) {
    Random random(seed);
    for (const auto& [name, field] : fields(Law{})) {
        for (const double bad : {-1.0, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()}) {
            auto p = draw_parameters<double>(random, Law{});
            CHECK(message_of([&] { p.require_valid("add_spring(3, 7)"); }) == "");
            p.*field = bad;
            const std::string words = name + " is ";
            CHECK(missing(message_of([&] { p.require_valid("add_spring(3, 7)"); }),
                          {"add_spring(3, 7)", words.c_str(), "must be finite and >"}) == "");
        }
    }
    const auto p = draw_parameters<double>(random, Law{});
    const auto back = p.template cast<float>().template cast<double>();
    for (const auto& [name, field] : fields(Law{})) CHECK(back.*field == p.*field);
}

template <class Law>
void test_law(std::uint32_t seed) {
    check_derivatives<Law, double>(seed);
    check_derivatives<Law, long double>(seed);
    check_bound_and_shape<Law>(seed + 1);
    // Glue's slope is not monotone, and it has no slope_range of its own.
    if (!std::is_same_v<Law, Glue>) check_slope_range<Law>(seed + 2);
    check_parameters<Law>(seed + 3);
    if constexpr (taut::step_detail::is_vectorizable_v<Law>) {
        check_registers<Law, float>(seed + 4);
        check_registers<Law, double>(seed + 5);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("law: its functions and its words agree", "[network]", Hookean, TensionOnly,
                   Buckling, Glue, Stiffening) {
    test_law<TestType>(1);
}

TEST_CASE("law: Hooke's spring by hand", "[network]") {
    const Hookean::Parameters<double> p{1000};
    CHECK_THAT(Hookean::tension(p, 0.5, 0.75), WithinRel(250.0, Tolerance<double>::rounding));
    CHECK_THAT(Hookean::tension(p, 0.5, 0.25), WithinRel(-250.0, Tolerance<double>::rounding));
    CHECK_THAT(Hookean::energy(p, 0.5, 0.75), WithinRel(31.25, Tolerance<double>::rounding));
    CHECK(Hookean::tension_slope(p, 0.5, 0.75) == 1000);
    CHECK(Hookean::stiffness_bound(p, 0.5) == 1000);
}

TEMPLATE_TEST_CASE("law: slack a string is nothing, taut it is Hooke's spring, to the ulp",
                   "[network]", float, double, long double) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        CAPTURE(trial);
        const auto p = draw_parameters<TestType>(random, TensionOnly{});
        const auto L = static_cast<TestType>(random.uniform(0.1, 2));
        const auto any = static_cast<TestType>(random.uniform(0, 4));
        const TestType beyond = std::nextafter(L, TestType(4));
        for (const TestType l : {any, std::nextafter(L, TestType(0)), L, beyond}) {
            const bool taut = l > L;
            CHECK(TensionOnly::tension(p, L, l) == (taut ? Hookean::tension(p, L, l) : 0));
            CHECK(TensionOnly::tension_slope(p, L, l) == (taut ? p.stiffness : 0));
            CHECK(TensionOnly::energy(p, L, l) == (taut ? Hookean::energy(p, L, l) : 0));
        }
        CHECK(TensionOnly::energy(p, L, beyond) > 0);
    }
}

TEST_CASE("law: the energy of strings is convex in their positions, that of springs is not",
          "[network]") {
    for (int dim = 1; dim <= 3; ++dim) {
        const auto bends_down = [&](LawOf law, Random& random) {
            Scene scene({false, dim, Laws::any});
            for (Index i = 0; i < 8; ++i)
                scene.add_particle(Eigen::VectorXd::Zero(dim), random.uniform(0.5, 2));
            for (int s = 0; s < 14; ++s) {
                auto spring = draw_spring(random, law);
                spring.a = random.below(8);
                spring.b = (spring.a + 1 + random.below(7)) % 8;
                spring.rest_length = random.uniform(0.2, 1.4);
                scene.add_spring(spring);
            }
            scene.set_gravity(random_vector(random, dim, -10, 10));
            const auto a = random_state(random, scene);
            const auto b = random_state(random, scene);
            auto between = a;
            const double t = random.uniform(0, 1);
            between.x = (1 - t) * a.x + t * b.x;
            const double chord =
                (1 - t) * scene.potential_energy(a) + t * scene.potential_energy(b);
            return scene.potential_energy(between) > chord + Tolerance<double>::rounding * 1e3;
        };
        int springs = 0;
        for (std::uint32_t seed = 1; seed <= 500; ++seed) {
            CAPTURE(dim, seed);
            Random random(seed);
            CHECK_FALSE(bends_down(LawOf::tension_only, random));
            springs += bends_down(LawOf::hookean, random);
        }
        CHECK(springs > 0);  // what the same poses show of springs that push
    }
}

}  // namespace taut_test::law_test
