// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "lammps_scenes.hpp"

#include <taut/lammps/lammps.hpp>
#include <taut/lattice/lattice.hpp>
#include <taut/taut.hpp>
#include <taut/wind/wind.hpp>
#include <taut/proof/bracket.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

taut::LammpsReport write_lammps(const std::string& folder, const Scene& scene,
                                const AnyState& state, const LammpsOptions& options) {
    taut::LammpsReport report;
    visit_system<Plain<float, 1>, Plain<float, 2>, Plain<float, 3>, Plain<double, 1>,
                 Plain<double, 2>, Plain<double, 3>, AnyLaw<double, 3>>(
        scene, [&](const auto& system) {
            using State = typename std::decay_t<decltype(system)>::State;
            report = taut::write_lammps(folder, system, from_any<State>(state), options);
        });
    return report;
}

namespace {

template <class Scalar, int Dim>
class DumpOn : public AnyDump {
public:
    DumpOn(const std::string& path, Index particles) : dump_(path, particles) {}
    taut::DumpReport read(AnyState& any) override {
        taut::State<Scalar, Dim> state;
        if (any.x.size() > 0) state = from_any<taut::State<Scalar, Dim>>(any);
        auto report = dump_.read(state);
        any = to_any(state);
        return report;
    }
    Index frames() const override { return dump_.frames(); }
    bool has_velocities() const override { return dump_.has_velocities(); }

private:
    taut::LammpsDump<Scalar, Dim> dump_;
};

template <class Scalar>
std::unique_ptr<AnyDump> open_dump(int dim, const std::string& path, Index particles) {
    if (dim == 1) return std::make_unique<DumpOn<Scalar, 1>>(path, particles);
    if (dim == 2) return std::make_unique<DumpOn<Scalar, 2>>(path, particles);
    return std::make_unique<DumpOn<Scalar, 3>>(path, particles);
}

Scene scene_of(const Plain<double, 3>& system) {
    Scene scene({});
    dynamic_cast<SceneOn<Plain<double, 3>>&>(scene.base()).system = system;
    return scene;
}

}  // namespace

std::unique_ptr<AnyDump> open_dump(const Kind& kind, const std::string& path, Index particles) {
    return kind.single ? open_dump<float>(kind.dim, path, particles)
                       : open_dump<double>(kind.dim, path, particles);
}

Scene cloth_scene(Index rows, Index columns) {
    return scene_of(taut::hanging_cloth<double>({rows, columns}));
}
Scene lattice_scene(const std::array<Index, 3>& size) {
    return scene_of(taut::lattice<double>({size}));
}

void blow(Scene& scene) {
    taut::Wind<double> wind;
    wind.triangles = {{0, 1, 2}};
    wind.density = wind.drag = 1;
    taut::set_wind(dynamic_cast<SceneOn<AnyLaw<double, 3>>&>(scene.base()).system, wind);
}

taut::Mode limiting_mode(const Scene& scene, const AnyState& state) {
    taut::Mode mode;
    visit_system<Plain<double, 3>>(scene, [&](const auto& system) {
        const taut::Stability<double> stability(system, from_any<taut::State<double, 3>>(state));
        mode = taut::limiting_mode(stability);
    });
    return mode;
}

}  // namespace taut_test
