// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

class AnyImex : public AnyStepper {
public:
    virtual taut::StepLimit<double> limit() const = 0;
    virtual double share(Index s) const = 0;
    virtual Index implicit_springs() const = 0;
    virtual Index touched() const = 0;
    virtual std::int64_t factorizations() const = 0;
    virtual double added_kinetic(const AnyState& state) const = 0;
};

/// Scenes that there is an ImexEuler for.
extern const std::vector<Kind> imex_kinds;

std::unique_ptr<AnyImex> imex(const Scene& scene, double step,
                              std::function<double(Index)> share = {}, int threads = 1);
/// It steps a StateView; scenes of two dimensions.
std::unique_ptr<AnyStepper> imex_of_view(const Scene& scene, double step);

}  // namespace taut_test
