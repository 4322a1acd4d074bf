// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What is certified and refuted over step h and damping α, and what a simulation does at each (h,
// α): a flat cloth without load, started 1e-7 m off rest. Prints CSV. "map" as argument: the cells;
// "limits": the certified and refuted steps over α; "multipliers": the multipliers of all modes
// just below and just above the limit.

#include <cmath>
#include <complex>
#include <cstdio>
#include <string>
#include <taut/tight/dense.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>

#include "../../examples/common/number.hpp"

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using taut::Index;
using taut::Method;

constexpr Method methods[] = {Method::explicit_euler, Method::symplectic_euler};
constexpr int columns = 44;  // over α
constexpr int rows = 44;     // over h

Cloth scene(double alpha) {
    taut::ClothOptions options;
    options.rows = options.columns = 6;
    options.gravity = 0;
    Cloth cloth = taut::hanging_cloth<double>(options);
    cloth.set_rayleigh({0, alpha});
    return cloth;
}

/// Evenly spaced logarithms.
double between(double low, double high, int i, int count) {
    return low * std::pow(high / low, (i + 0.5) / count);
}
// 1/ω of the stiffest mode is 1.1e-3 s.
double step_at(int row) { return between(1e-4, 4e-3, row, rows); }
double alpha_at(int column) { return between(1e-5, 2e-2, column, columns); }

/// The factor by which a displacement has grown in up to `steps` steps; stops at 1000.
template <class Stepper>
double growth(const Cloth& cloth, const Cloth::State& start, double h, Index steps) {
    const auto rest = cloth.initial_state();
    Cloth::State state = start;
    Stepper stepper(cloth);
    const double first = (state.x - rest.x).norm();
    double largest = 1;
    for (Index taken = 0; taken < steps && largest < 1000; taken += 100) {
        if (!stepper.step(state, h, 100)) return 1000;
        largest = std::max(largest, (state.x - rest.x).norm() / first);
    }
    return std::min(largest, 1000.0);
}

/// Off rest along every stiff mode; mechanisms, which no force moves, are left alone.
Cloth::State disturbed(const Cloth& cloth) {
    auto state = cloth.initial_state();
    const taut::LinearSystem<double> linear = taut::linearize(cloth, state);
    const Eigen::VectorXd push =
        linear.stiffness() * taut::proof_detail::scattered_vector(linear.size());
    auto u = linear.to_free(state);
    u.x = 1e-7 / push.norm() * push.transpose();
    linear.from_free(u, state);
    return state;
}

void print_map() {
    std::printf("method,h_s,alpha_s,analysis,growth\n");
    for (const Method method : methods) {
        for (int column = 0; column < columns; ++column) {
            const Cloth cloth = scene(alpha_at(column));
            const auto start = disturbed(cloth);
            const auto limit =
                taut::bracket(taut::Stability<double>(cloth, cloth.initial_state()), method);
            for (int row = 0; row < rows; ++row) {
                const double h = step_at(row);
                const char* analysis = h <= limit.certified ? "certified"
                                       : h >= limit.refuted ? "refuted"
                                                            : "between";
                const double grown =
                    method == Method::explicit_euler
                        ? growth<taut::ExplicitEuler<Cloth>>(cloth, start, h, 20000)
                        : growth<taut::SymplecticEuler<Cloth>>(cloth, start, h, 20000);
                std::printf("%s,%.6g,%.6g,%s,%.4g\n", name(method), h, alpha_at(column), analysis,
                            grown);
            }
        }
    }
}

void print_limits() {
    std::printf("method,alpha_s,certified_s,refuted_s\n");
    for (const Method method : methods) {
        for (int i = 0; i <= 200; ++i) {
            const double alpha = 1e-5 * std::pow(2000, i / 200.0);
            const Cloth cloth = scene(alpha);
            const auto limit =
                taut::bracket(taut::Stability<double>(cloth, cloth.initial_state()), method);
            std::printf("%s,%.6g,%s,%s\n", name(method), alpha,
                        example::rounded_down(limit.certified, 8, 'g').c_str(),
                        example::rounded_up(limit.refuted, 8, 'g').c_str());
        }
    }
}

void print_multipliers() {
    std::printf("method,part_of_limit,h_s,alpha_s,re,im\n");
    for (const Method method : methods) {
        const double alpha = 8e-4;
        const Cloth cloth = scene(alpha);
        const taut::Stability<double> stability(cloth, cloth.initial_state());
        const auto limit = taut::max_step(stability, method, 1e-6);
        const taut::DenseAnalysis<> dense(stability.pencil());
        for (const double part : {0.99, 1.01}) {
            const double h = part * (part < 1 ? limit.certified : limit.refuted);
            for (const double k : dense.stiffness_eigenvalues()) {
                if (k <= dense.zero_tolerance()) continue;
                for (const auto& mu : taut::multipliers(method, k, alpha * k, h)) {
                    std::printf("%s,%.2f,%.6g,%.6g,%.9g,%.9g\n", name(method), part, h, alpha,
                                mu.real(), mu.imag());
                }
            }
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "map") {
        print_map();
    } else if (what == "limits") {
        print_limits();
    } else if (what == "multipliers") {
        print_multipliers();
    } else {
        std::fprintf(stderr, "stability_map: needs map, limits or multipliers\n");
        return 1;
    }
}
