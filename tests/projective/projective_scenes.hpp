// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

class AnyProjective : public AnyStepper {
public:
    virtual int iterations() const = 0;
    virtual std::int64_t factorizations() const = 0;
    /// The last matrix that was factorised, if the solver is Eigen's.
    virtual Eigen::MatrixXd matrix() const = 0;
};

struct ProjectiveLimits {
    int iterations = 10;
    double tolerance = 0;
    int window = 5;
};

/// Scenes that there is a ProjectiveDynamics for.
extern const std::vector<Kind> projective_kinds;

std::unique_ptr<AnyProjective> projective(const Scene& scene, const ProjectiveLimits& limits = {});
/// With one of Eigen's solvers; of these kinds.
constexpr Kind eigen_kinds[] = {
    {false, 1, Laws::any}, {false, 2, Laws::any}, {false, 3, Laws::any}, {true, 1}, {true, 2},
    {true, 3, Laws::any}};
std::unique_ptr<AnyProjective> projective_by_eigen(const Scene& scene);

}  // namespace taut_test
