// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstring>
#include <limits>
#include <taut/bdf2/bdf2.hpp>
#include <taut/model/state_view.hpp>
#include <taut/projective/projective.hpp>
#include <taut/scene/cloth.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"

namespace taut_test::state_view_test {

using taut::StateView;
using taut::Status;

namespace {

template <class Scalar>
using Cloth = taut::SpringSystem<Scalar, 3>;

/// An engine's memory: positions and velocities with strides, anything in between.
template <class Stored, int Dim>
struct Arrays {
    Arrays(Index count, Index x_stride_, Index v_stride_)
        : n(count), x_stride(x_stride_), v_stride(v_stride_) {
        x.assign(static_cast<std::size_t>(n * x_stride), Stored(-77));
        v.assign(static_cast<std::size_t>(n * v_stride), Stored(-78));
    }
    StateView<Stored, Dim> view() { return {x.data(), x_stride, v.data(), v_stride, n}; }
    bool padding_untouched() const {
        const auto kept = [&](const std::vector<Stored>& numbers, Index stride, Stored padding) {
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (static_cast<Index>(i) % stride >= Dim && numbers[i] != padding) return false;
            }
            return true;
        };
        return kept(x, x_stride, Stored(-77)) && kept(v, v_stride, Stored(-78));
    }

    Index n, x_stride, v_stride;
    std::vector<Stored> x, v;
};

/// What a state is once its numbers have been stored.
template <class Stored, class Scalar, int Dim>
void round_to(taut::State<Scalar, Dim>& state) {
    state.x = state.x.template cast<Stored>().template cast<Scalar>().eval();
    state.v = state.v.template cast<Stored>().template cast<Scalar>().eval();
}

/// Steps on the arrays are those on a State, to the bit, whatever the layout; calls that follow one
/// another too.
template <class Stored, class Stepper, class System>
void check_view(const System& system, typename System::State state, double step) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    const auto h = static_cast<Scalar>(step);
    round_to<Stored>(state);
    for (const auto& [x_stride, v_stride] :
         {std::pair(Dim, Dim), std::pair(4, 4), std::pair(7, 3)}) {
        INFO("strides " << x_stride << " and " << v_stride);
        Arrays<Stored, Dim> arrays(system.size(), x_stride, v_stride);
        auto view = arrays.view();
        view.copy_from(state);
        auto expected = state;
        Stepper on_view(system);
        Stepper on_state(system);
        for (const Index count : {1, 3, 2}) {
            const auto report = on_view.step(view, h, count);
            REQUIRE(report);
            REQUIRE(on_state.step(expected, h, count));
            CHECK(report.iterations == count);
            round_to<Stored>(expected);
        }
        typename System::State result;
        view.copy_to(result);
        CHECK(result.x == expected.x);
        CHECK(result.v == expected.v);
        CHECK(std::abs(view.time - 6 * step) <= 1e-6 * step);
        CHECK(arrays.padding_untouched());
    }
}

}  // namespace

TEST_CASE("state_view: steps on arrays are those on a State", "[integrator]") {
    auto narrow = taut::hanging_cloth<float>({6, 5});
    auto state = narrow.initial_state();
    state.v = Random(31).points<float, 3>(narrow.size(), -1, 1);
    check_view<float, taut::SymplecticEuler<Cloth<float>>>(narrow, state, 1e-4);
    check_view<double, taut::ImplicitEuler<Cloth<float>>>(narrow, state, 1e-2);
    narrow.set_external_force([](const auto& s, auto& f) { f -= 0.1f * s.v; });
    check_view<float, taut::SymplecticEuler<Cloth<float>>>(narrow, state, 1e-4);

    auto wide = taut::hanging_cloth<double>({6, 5});
    const taut::State<double, 3> start{state.x.cast<double>(), state.v.cast<double>()};
    // Not velocity Verlet on float arrays: its force is that of the unrounded state.
    check_view<double, taut::VelocityVerlet<Cloth<double>>>(wide, start, 1e-4);
    check_view<double, taut::ProjectiveDynamics<Cloth<double>>>(wide, start, 1e-2);
    check_view<float, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);
    check_view<float, taut::ImplicitEuler<Cloth<double>>>(wide, start, 1e-2);
    wide.set_external_force([](const auto& s, auto& f) { f -= 0.1 * s.v; });
    check_view<float, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);

    const auto linear = taut::linearize(wide, wide.initial_state());
    auto small = linear.initial_state();
    small.v.setLinSpaced(-1, 1);
    check_view<double, taut::Bdf2<taut::LinearSystem<double>>>(linear, small, 1e-2);
}

TEST_CASE("state_view: a failed step leaves the arrays alone", "[integrator]") {
    auto cloth = taut::hanging_cloth<double>({6, 6});
    Arrays<float, 3> arrays(cloth.size(), 5, 3);
    auto view = arrays.view();
    view.copy_from(cloth.initial_state());
    const auto check = [&](Status status, Index where, double h, Index count) {
        const auto x = arrays.x;
        const auto v = arrays.v;
        taut::SymplecticEuler stepper(cloth);
        const auto report = stepper.step(view, h, count);
        CHECK(report.status == status);
        if (where >= 0) CHECK(report.where == where);
        CHECK(std::memcmp(x.data(), arrays.x.data(), x.size() * sizeof(float)) == 0);
        CHECK(std::memcmp(v.data(), arrays.v.data(), v.size() * sizeof(float)) == 0);
        CHECK(view.time == 0);
    };
    for (const bool external : {false, true}) {
        if (external) cloth.set_external_force([](const auto&, auto& f) { f.array() += 1e-3; });
        check(Status::invalid_step, -1, -1, 1);
        check(Status::diverged, -1, 1, 200);
        CHECK(view.finite());
        view.v(1, 20) = std::numeric_limits<float>::quiet_NaN();
        CHECK_FALSE(view.finite());
        CHECK(view.first_not_finite() == 20);
        check(Status::invalid_state, 20, 1e-4, 1);
        view.v(1, 20) = 0;
    }
    float three[3] = {};
    StateView<float, 3> other(three, three, 1);
    taut::SymplecticEuler stepper(cloth);
    CHECK(stepper.step(other, 1e-4).status == Status::invalid_state);

    const auto narrow = taut::hanging_cloth<float>({6, 6});
    Arrays<double, 3> wide(narrow.size(), 3, 3);
    auto wide_view = wide.view();
    wide_view.copy_from(narrow.initial_state());
    wide_view.v(1, 20) = 1e300;  // too large for the float of the system
    taut::ImplicitEuler implicit(narrow);
    const auto report = implicit.step(wide_view, 1e-2f);
    CHECK(report.status == Status::invalid_state);
    CHECK(report.where == 20);
}

TEST_CASE("state_view: wrong layouts are named", "[integrator]") {
    float numbers[12] = {};
    using View = StateView<float, 3>;
    const auto says = [](auto&& make) { return message_of([&] { (void)make(); }); };
    CHECK(missing(says([&] { return View(numbers, numbers, 2, 2); }),
                  {"StateView", "stride of positions is 2", ">= 3"}) == "");
    CHECK(missing(says([&] { return View(numbers, 3, numbers, 1, 2); }),
                  {"stride of velocities is 1"}) == "");
    CHECK(missing(says([&] { return View(numbers, nullptr, 2); }),
                  {"velocities is a null pointer"}) == "");
    CHECK(missing(says([&] { return View(numbers, numbers, -1); }), {"particles is -1"}) == "");
    CHECK(View(nullptr, nullptr, 0).x.cols() == 0);
    View two(numbers, numbers + 6, 2);
    CHECK(missing(says([&] {
                      two.copy_from(taut::hanging_cloth<float>({2, 2}).initial_state());
                      return 0;
                  }),
                  {"copy_from", "4 positions", "2 particles"}) == "");
}

}  // namespace taut_test::state_view_test
