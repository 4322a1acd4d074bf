// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/projective/projective.hpp>

#include "../support/scene_on.hpp"
#include "projective_scenes.hpp"

namespace taut_test {

/// Keeps the last matrix that it factorised.
template <class Scalar>
struct Witness : Eigen::SimplicialLLT<taut::SparseMatrix<Scalar>> {
    static inline Eigen::MatrixXd seen;

    void factorize(const taut::SparseMatrix<Scalar>& A) {
        seen = Eigen::MatrixXd(A.template cast<double>());
        Eigen::SimplicialLLT<taut::SparseMatrix<Scalar>>::factorize(A);
    }
};

template <class System, class... Solver>
class ProjectiveOn
    : public StepperOn<taut::ProjectiveDynamics<System, Solver...>, System, AnyProjective> {
public:
    using Stepper = taut::ProjectiveDynamics<System, Solver...>;
    using StepperOn<Stepper, System, AnyProjective>::StepperOn;

    int iterations() const override { return this->stepper_.iterations(); }
    std::int64_t factorizations() const override { return this->stepper_.factorizations(); }
    Eigen::MatrixXd matrix() const override { return Witness<typename System::Scalar>::seen; }
};

template <template <class> class Of, class... Systems>
std::unique_ptr<AnyProjective> make_projective(const Scene& scene, const ProjectiveLimits& limits) {
    std::unique_ptr<AnyProjective> made;
    visit_system<Systems...>(scene, [&](const auto& system) {
        using Made = Of<std::decay_t<decltype(system)>>;
        typename Made::Stepper::Options options;
        options.iterations = limits.iterations;
        options.tolerance = limits.tolerance;
        options.window = limits.window;
        made = std::make_unique<Made>(system, options);
    });
    return made;
}

template <class System>
using Default = ProjectiveOn<System>;
template <class System>
using ByEigen = ProjectiveOn<System, Witness<typename System::Scalar>>;

/// Compiled apart.
std::unique_ptr<AnyProjective> projective_by_eigen_in_float(const Scene& scene);

}  // namespace taut_test
