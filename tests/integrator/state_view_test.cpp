// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <limits>
#include <taut/scene/cloth.hpp>
#include <taut/taut.hpp>

#include "../support/message.hpp"
#include "arrays.hpp"

namespace taut_test::state_view_test {

using taut::StateView;
using taut::Status;

TEST_CASE("state_view: explicit steps on arrays are those on a State", "[integrator]") {
    auto narrow = taut::hanging_cloth<float>({6, 5});
    auto state = narrow.initial_state();
    state.v = Random(31).points<float, 3>(narrow.size(), -1, 1);
    check_view<float, taut::SymplecticEuler<Cloth<float>>>(narrow, state, 1e-4);
    check_view<float, taut::VelocityVerlet<Cloth<float>>>(narrow, state, 1e-4);
    narrow.set_external_force([](const auto& s, auto& f) { f -= 0.1f * s.v; });
    check_view<float, taut::SymplecticEuler<Cloth<float>>>(narrow, state, 1e-4);

    auto wide = taut::hanging_cloth<double>({6, 5});
    const taut::State<double, 3> start{state.x.cast<double>(), state.v.cast<double>()};
    // Not velocity Verlet on float arrays: its force is that of the unrounded state.
    check_view<double, taut::VelocityVerlet<Cloth<double>>>(wide, start, 1e-4);
    check_view<double, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);
    check_view<float, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);
    wide.set_external_force([](const auto& s, auto& f) { f -= 0.1 * s.v; });
    check_view<double, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);
    check_view<float, taut::SymplecticEuler<Cloth<double>>>(wide, start, 1e-4);
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
