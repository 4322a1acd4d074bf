// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "imex_scenes.hpp"

#include <taut/model/state_view.hpp>

#include "imex_on.hpp"

namespace taut_test {

namespace {

using Planar = Strings<double, 2>;

class ImexOfView : public AnyStepper {
public:
    ImexOfView(const Planar& system, double step) : stepper_(system, {step, {}, 1}) {}

    taut::Report step(AnyState& any, double h, Index count) override {
        auto state = from_any<Planar::State>(any);
        taut::StateView<double, 2> view(state.x.data(), state.v.data(), state.x.cols());
        const auto report = stepper_.step(view, h, count);
        any = to_any(state);
        return report;
    }

private:
    taut::ImexEuler<Planar> stepper_;
};

}  // namespace

const std::vector<Kind> imex_kinds = {
    {false, 1}, {false, 2, Laws::strings}, {false, 3, Laws::mixed}, {true, 3, Laws::strings}};

std::unique_ptr<AnyImex> imex(const Scene& scene, double step, std::function<double(Index)> share,
                              int threads) {
    std::unique_ptr<AnyImex> made;
    const taut::ImexOptions options{step, std::move(share), threads};
    if (scene.dim() == 3) return imex_in_3d(scene, options);
    visit_system<Plain<double, 1>, Planar>(scene, [&](const auto& system) {
        made = std::make_unique<ImexOn<std::decay_t<decltype(system)>>>(system, options);
    });
    return made;
}

std::unique_ptr<AnyStepper> imex_of_view(const Scene& scene, double step) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Planar>(
        scene, [&](const Planar& system) { made = std::make_unique<ImexOfView>(system, step); });
    return made;
}

}  // namespace taut_test
