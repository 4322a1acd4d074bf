// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "analysis.hpp"

#include "scene_on.hpp"

namespace taut_test {

namespace {

using Either = std::variant<taut::Stability<float>, taut::Stability<double>>;

Either of_scene(const Scene& scene, const AnyState& state) {
    std::unique_ptr<Either> of;
    visit_any_system(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        using Stability = taut::Stability<typename System::Scalar>;
        of = std::make_unique<Either>(Stability(system, from_any<typename System::State>(state)));
    });
    return *of;
}

Either of_matrices(const Matrices& m) {
    if (m.single) return taut::Stability<float>(linear_system<float>(m));
    return taut::Stability<double>(linear_system<double>(m));
}

}  // namespace

Exact exact_matrices(const Matrices& m) {
    if (m.single) return exact_matrices(linear_system<float>(m));
    return exact_matrices(linear_system<double>(m));
}

Matrices linearized(const Scene& scene, const AnyState& state) {
    Matrices m;
    m.single = scene.kind().single;
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<float, 3>, Plain<double, 1>,
                 Plain<double, 2>, Plain<double, 3>>(scene, [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        const auto linear = taut::linearize(system, from_any<typename System::State>(state));
        m.mass = linear.mass().template cast<double>();
        m.damping = linear.damping().toDense().template cast<double>();
        m.stiffness = linear.stiffness().toDense().template cast<double>();
    });
    return m;
}

Analysis::Analysis(const Scene& scene, const AnyState& state) : of_(of_scene(scene, state)) {}
Analysis::Analysis(const Matrices& m) : of_(of_matrices(m)) {}

taut::StepLimit<double> Analysis::max_step(taut::Method method, double tightness) const {
    return std::visit([&](const auto& s) { return to_any(taut::max_step(s, method, tightness)); },
                      of_);
}
bool Analysis::proves(taut::Method method, double h) const {
    return std::visit([&](const auto& s) { return taut::certify(s, method, h).proved; }, of_);
}
double Analysis::max_stiffness_scale(taut::Method method, double h) const {
    return std::visit([&](const auto& s) { return s.max_stiffness_scale(method, h); }, of_);
}
double Analysis::min_mass_scale(taut::Method method, double h) const {
    return std::visit([&](const auto& s) { return s.min_mass_scale(method, h); }, of_);
}
taut::StiffnessSpectrum Analysis::stiffness_spectrum() const {
    return std::visit([](const auto& s) { return taut::stiffness_spectrum(s); }, of_);
}
const taut::Pencil& Analysis::pencil() const {
    return std::visit([](const auto& s) -> const taut::Pencil& { return s.pencil(); }, of_);
}

}  // namespace taut_test
