// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What the library answers at the ends of its range, and what rounding costs there:
// bench/results/extremes.md. Ten steps in float and in double are compared with the same steps in
// long double.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/lattice/lattice.hpp>
#include <taut/taut.hpp>
#include <taut/proof/bracket.hpp>
#include <type_traits>

#include "../examples/common/number.hpp"

namespace {

using taut::Index;
using taut::Spring;

template <class Scalar>
using System = taut::SpringSystem<Scalar, 3>;
template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

std::string number(double value, const char* format = "%.3g") {
    if (std::isinf(value)) return "any";
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string certified_text(double h) {
    return std::isinf(h) ? "any" : example::rounded_down(h, 3, 'g');
}

/// Velocities of about 0.1 m/s that differ from particle to particle; the same in every precision.
template <class Scalar>
taut::State<Scalar, 3> disturbed(const System<Scalar>& system) {
    auto state = system.initial_state();
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const auto t = static_cast<float>(i);
        state.v.col(i) = (0.1F * Eigen::Vector3f(std::sin(t), std::cos(2 * t), std::sin(3 * t)))
                             .template cast<Scalar>();
    }
    return state;
}

template <class Scalar>
struct Outcome {
    taut::Report report;
    taut::State<Scalar, 3> state;
};

template <template <class...> class Stepper, class Scalar>
Outcome<Scalar> ten_steps(const System<Scalar>& system, double h) {
    Outcome<Scalar> outcome{{}, disturbed(system)};
    Stepper<System<Scalar>> stepper(system);
    outcome.report = stepper.step(outcome.state, static_cast<Scalar>(h), 10);
    return outcome;
}

/// The largest error of a position over the longest way that a particle went.
template <class Scalar, class Reference>
std::string answer(const Outcome<Scalar>& outcome, const Outcome<Reference>& exact,
                   const taut::Points<Reference, 3>& start) {
    if (!outcome.report) return std::string("refused: ") + describe(outcome.report.status);
    if (std::is_same_v<Scalar, Reference> || !exact.report) return "ok";
    const Reference way = (exact.state.x - start).colwise().norm().maxCoeff();
    const auto x = outcome.state.x.template cast<Reference>();
    const Reference error = (x - exact.state.x).colwise().norm().maxCoeff();
    return error == 0 ? "exact" : number(static_cast<double>(error / way), "%.0e");
}

template <class Reference, template <class...> class Stepper, class Make>
std::string both(const Make& make, double h) {
    const auto reference = make(Reference());
    const auto exact = ten_steps<Stepper>(reference, h);
    const auto in = [&](auto scalar) -> std::string {
        try {
            const auto outcome = ten_steps<Stepper>(make(scalar), h);
            return answer(outcome, exact, reference.initial_state().x);
        } catch (const std::invalid_argument&) {
            return "refused: the scene";
        }
    };
    const std::string in_double = in(0.0);
    const std::string in_float = in(0.0F);
    return in_double == in_float ? in_double : in_double + "; float: " + in_float;
}

/// @param make  the scene in the precision of its argument  @param h  of implicit Euler, s
template <class Reference = long double, template <class...> class Implicit = taut::ImplicitEuler,
          class Make>
void row(const char* asked, const Make& make, double h = 1.0 / 60, double explicit_h = 0) try {
    const System<double> system = make(0.0);
    const taut::Stability<double> stability(system, system.initial_state());
    const auto limit = taut::bracket(stability, taut::Method::symplectic_euler);
    const double any = taut::any_pose_limit(system).certified;
    if (explicit_h == 0) explicit_h = std::isfinite(any) ? 0.9 * any : 1.0 / 60;
    const double width = limit.refuted / limit.certified - 1;
    std::printf("| %s | %s | %s | %s | %s | %s |\n", asked, certified_text(limit.certified).c_str(),
                std::isfinite(limit.certified) ? number(width, "%.1e").c_str() : "–",
                name(limit.cause), both<Reference, taut::SymplecticEuler>(make, explicit_h).c_str(),
                both<Reference, Implicit>(make, h).c_str());
    std::fflush(stdout);
} catch (const std::invalid_argument& refusal) {
    std::printf("| %s | refused: %s | | | | |\n", asked, refusal.what());
}

template <class System>
using ByConjugateGradients =
    taut::ImplicitEuler<System, taut::ConjugateGradient<typename System::Scalar, System::Dim>>;

struct Pair {
    double stiffness = 100;  // N/m
    double mass_a = 1, mass_b = 1;
    double length = 1, rest_length = 1;  // m
    double origin = 0;                   // m
    bool pinned = false;
};

/// Two particles and a spring.
auto pair(const Pair& p) {
    return [p](auto scalar) {
        using Scalar = decltype(scalar);
        const auto in = [](double value) { return static_cast<Scalar>(value); };
        System<Scalar> system;
        system.add_particle(Vector<Scalar>::Constant(in(p.origin)), in(p.mass_a));
        system.add_particle(Vector<Scalar>(in(p.origin + p.length), in(p.origin), in(p.origin)),
                            in(p.mass_b));
        system.add_spring(
            Spring<Scalar, taut::Hookean>{0, 1, {in(p.stiffness)}, in(p.rest_length), Scalar(0)});
        if (p.pinned) {
            system.pin(0);
            system.pin(1);
        }
        return system;
    };
}

auto cloth(const taut::ClothOptions& options) {
    return [options](auto scalar) { return taut::hanging_cloth<decltype(scalar)>(options); };
}

auto small_cloth() {
    taut::ClothOptions options;
    options.rows = options.columns = 8;
    return options;
}

auto chain(const taut::ChainOptions& options) {
    return [options](auto scalar) { return taut::chain<decltype(scalar), 3>(options); };
}

/// A chain whose masses alternate between two values.
auto alternating(double light, double heavy) {
    return [light, heavy](auto scalar) {
        using Scalar = decltype(scalar);
        taut::ChainOptions options;
        options.masses = 20;
        options.stiffness = 100;
        auto system = taut::chain<Scalar, 3>(options);
        for (Index i = 0; i < options.masses; ++i)
            system.set_mass(i, static_cast<Scalar>(i % 2 == 0 ? light : heavy));
        return system;
    };
}

void strengths_and_masses() {
    row("stiffness 1e-12 N/m", pair({1e-12}));
    row("stiffness 1e15 N/m", pair({1e15}));
    row("masses 1e-9 and 1 kg on one spring", pair({100, 1e-9, 1}));
    row("masses 1e-9 and 1e9 kg in turn along a chain of 20", alternating(1e-9, 1e9));
    row("stiffness 1e-310 N/m (subnormal)", pair({1e-310}));
    row("mass 1e-310 kg (subnormal)", pair({100, 1e-310, 1}));
    row("mass 1e-300 kg", pair({100, 1e-300, 1}));
    row("stiffness 1e300 N/m", pair({1e300}));
    row("masses 1e300 kg", pair({100, 1e300, 1e300}));
}

void steps() {
    row("cloth 8 × 8, both steps 1e-12 s", cloth(small_cloth()), 1e-12, 1e-12);
    row("cloth 8 × 8, both steps 1e6 s", cloth(small_cloth()), 1e6, 1e6);
}

void sizes() {
    row("one particle, no spring", [](auto scalar) {
        System<decltype(scalar)> system;
        system.add_particle(Vector<decltype(scalar)>::Zero(), 1);
        system.set_gravity(Vector<decltype(scalar)>::Unit(2) * decltype(scalar)(-10));
        return system;
    });
    taut::ClothOptions large;
    large.rows = large.columns = 448;
    row<double, ByConjugateGradients>(
        "cloth 448 × 448: 200 704 particles, 1.2 million springs; implicit step 1e-3 s",
        cloth(large), 1e-3);
    taut::ChainOptions links;
    links.masses = 100'000;
    links.ends = taut::ChainEnds::fixed_free;
    row<double>("chain of 100 000, condition 1e10", chain(links));
}

void lengths() {
    row("coincident particles, rest length 1 m", pair({100, 1, 1, 0, 1}));
    row("rest length 0", pair({100, 1, 1, 1, 0}));
    row("coincident particles, rest length 0", pair({100, 1, 1, 0, 0}));
    row("compressed to a millionth of its rest length", pair({100, 1, 1, 1e-6, 1}));
    row("stretched to a million times its rest length", pair({100, 1, 1, 1, 1e-6}));
    row("1e8 m from the origin", pair({100, 1, 1, 1, 0.5, 1e8}));
}

void topologies() {
    auto free = small_cloth();
    free.pin_corners = false;
    row("cloth 8 × 8 in free flight", cloth(free));
    row("every particle pinned", pair({100, 1, 1, 1, 1, 0, true}));
    row("two cloths 8 × 8 and a lone particle in one system", [](auto scalar) {
        using Scalar = decltype(scalar);
        auto system = taut::hanging_cloth<Scalar>(small_cloth());
        const auto other = system;
        const Index first = system.size();
        for (Index i = 0; i < first; ++i)
            system.add_particle(other.initial_state().x.col(i), other.mass(i));
        const auto& springs = other.springs();
        for (std::size_t s = 0; s < springs.a.size(); ++s) {
            system.add_spring(first + springs.a[s], first + springs.b[s],
                              springs.parameters[s].stiffness);
        }
        system.add_particle(Vector<Scalar>::Constant(5), 1);
        return system;
    });
}

}  // namespace

int main() {
    std::printf(
        "# At the extremes\n\n"
        "Generated by `build/bench/bench/extremes_table > bench/results/extremes.md` after\n"
        "`cmake --preset bench && cmake --build --preset bench --target extremes_table`. The same\n"
        "ranges are tested at random by `ctest --preset test -L extremes`.\n\n"
        "Certified: the proved step of symplectic Euler at the initial pose, s, by bounds alone.\n"
        "Width: refuted/certified − 1. The last two columns take ten steps, symplectic Euler at\n"
        "0.9 of the any-pose limit (1/60 s where there is none) and implicit Euler at 1/60 s, "
        "unless\n"
        "the row says otherwise: the refusal by name, or the largest error of a position against "
        "the\n"
        "same steps in long double, relative to the longest way that a particle went; in double, "
        "and\n"
        "in float where it differs. Two large scenes take double for the reference, and the cloth\n"
        "steps by conjugate gradients. A state keeps positions, so where a particle at a distance "
        "r\n"
        "of the origin goes a short way w, the rounding of r alone makes an error of r/w times\n"
        "1e-16, or 6e-8 in float.\n\n"
        "| asked | certified, s | width | cause | symplectic Euler | implicit Euler |\n"
        "|---|---|---|---|---|---|\n");
    strengths_and_masses();
    steps();
    sizes();
    lengths();
    topologies();
}
