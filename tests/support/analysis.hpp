// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <variant>
#include <taut/proof/bracket.hpp>

#include "compiled_once.hpp"
#include "referee.hpp"
#include "scene.hpp"

namespace taut_test {

/// A linear system of bare matrices, rounded to its scalar.
struct Matrices {
    Eigen::VectorXd mass;
    Eigen::MatrixXd damping;  ///< 0 × 0: none
    Eigen::MatrixXd stiffness;
    bool single = false;
};

template <class Scalar>
taut::LinearSystem<Scalar> linear_system(const Matrices& m) {
    return {m.mass.cast<Scalar>(), m.damping.cast<Scalar>().eval().sparseView(),
            m.stiffness.cast<Scalar>().eval().sparseView()};
}
/// K⁺ = K.
Exact exact_matrices(const Matrices& m);

/// taut::linearize, without the load. Of Hookean springs.
Matrices linearized(const Scene& scene, const AnyState& state);

/// Stability of a scene's pose or of matrices, of either scalar; steps pass as double.
class Analysis {
public:
    Analysis(const Scene& scene, const AnyState& state);
    explicit Analysis(const Matrices& m);

    taut::StepLimit<double> max_step(taut::Method method, double tightness = 0) const;
    /// taut::certify
    bool proves(taut::Method method, double h) const;
    double max_stiffness_scale(taut::Method method, double h) const;
    double min_mass_scale(taut::Method method, double h) const;
    taut::StiffnessSpectrum stiffness_spectrum() const;
    const taut::Pencil& pencil() const;
    const taut::Stability<double>& in_double() const {
        return std::get<taut::Stability<double>>(of_);
    }

private:
    std::variant<taut::Stability<float>, taut::Stability<double>> of_;
};

}  // namespace taut_test
