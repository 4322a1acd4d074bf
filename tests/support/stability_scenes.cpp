// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "support/stability_scenes.hpp"

#include <taut/taut.hpp>  // what Taut::Compiled holds

namespace taut_test {

template <class Scalar>
std::vector<StabilityCase<Scalar>> stability_cases(bool with_damping) {
    std::vector<StabilityCase<Scalar>> cases;
    for_each_scene<Scalar>([&](const std::string& scene, const auto& system, const auto& state) {
        if (!with_damping) {
            cases.push_back(stability_case<Scalar>(scene, system, state));
            return;
        }
        const double omega = Multipliers(exact_matrices(system, state.x)).omega();
        for_each_damping(system, omega, [&](const std::string& damping, const auto& damped) {
            cases.push_back(stability_case<Scalar>(scene + ", " + damping, damped, state));
        });
    });
    return cases;
}

template std::vector<StabilityCase<float>> stability_cases(bool);
template std::vector<StabilityCase<double>> stability_cases(bool);

Eigen::MatrixXd with_spectrum(Random& random, const Eigen::VectorXd& spectrum) {
    const Index N = spectrum.size();
    RealMatrix G(N, N);
    for (Index i = 0; i < N * N; ++i) G.data()[i] = random.uniform(-1, 1);
    const Eigen::MatrixXd Q = orthogonal(G).cast<double>();
    const Eigen::MatrixXd A = Q * spectrum.asDiagonal() * Q.transpose();
    return 0.5 * (A + A.transpose());
}

}  // namespace taut_test
