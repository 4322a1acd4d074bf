// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "network_scenes.hpp"

#include <taut/network/tangent_matrix.hpp>
#include <taut/own_matrices/linearize.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

namespace {

template <class Visit>
void visit_tangent_system(const Scene& scene, Visit&& visit) {
    visit_system<Plain<float, 1>, Plain<float, 2>, AnyLaw<double, 1>, AnyLaw<double, 2>,
                 AnyLaw<double, 3>, AnyLaw<float, 3>>(scene, visit);
}

template <class Matrix>
Eigen::MatrixXd dense(const Matrix& A) {
    return Eigen::MatrixXd(A.template cast<double>());
}

}  // namespace

std::vector<Kind> tangent_kinds() {
    auto kinds = kinds_of(Laws::any);
    for (int dim = 1; dim <= 2; ++dim) kinds.push_back({true, dim, Laws::hookean});
    return kinds;
}

std::vector<Kind> linearized_kinds() {
    return {{false, 1, Laws::any}, {true, 2, Laws::hookean}, {false, 3, Laws::any}};
}

Linearization linearization(const Scene& scene, const AnyState& any) {
    Linearization result;
    visit_system<Plain<float, 2>, AnyLaw<double, 1>, AnyLaw<double, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            const auto linear = taut::linearize(system, from_any<typename System::State>(any));
            result = {linear.mass().template cast<double>(), linear.load().template cast<double>(),
                      dense(linear.stiffness()), dense(linear.damping()),
                      linear.stiffness().nonZeros()};
            if (linear.damping().nonZeros() != result.entries)
                throw std::logic_error("other pattern");
        });
    return result;
}

std::vector<Eigen::MatrixXd> assembled(const Scene& scene, const AnyState& any,
                                       const std::vector<taut::Combination>& sums) {
    std::vector<Eigen::MatrixXd> result;
    visit_tangent_system(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        using Scalar = typename System::Scalar;
        const taut::TangentMatrix<Scalar, System::Dim> tangent(system);
        auto A = tangent.zero();
        const auto x = from_any<typename System::State>(any).x;
        for (const auto& sum : sums) {
            tangent.assemble(system, x, sum, A);
            result.push_back(dense(A));
        }
    });
    return result;
}

std::vector<AnyTangent> tangents(const Scene& scene, const AnyState& any) {
    std::vector<AnyTangent> result;
    visit_tangent_system(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        const auto x = from_any<typename System::State>(any).x;
        system.for_each_tangent(x, [&](const auto& t) {
            const auto plus = t.projected();
            result.push_back({t.a, t.b, t.d.template cast<double>(), double(t.axial),
                              double(t.transverse), double(t.bound), double(t.damping),
                              double(plus.axial), double(plus.transverse)});
        });
    });
    return result;
}

}  // namespace taut_test
