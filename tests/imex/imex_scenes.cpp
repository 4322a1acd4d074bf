// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "imex_scenes.hpp"

#include <taut/network/state_view.hpp>

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

const std::vector<Kind> imex_kinds = {{false, 1, Laws::any},
                                      {false, 2, Laws::any},
                                      {false, 3, Laws::any},
                                      {true, 3, Laws::any},
                                      {true, 2},
                                      {false, 2, Laws::strings}};

std::unique_ptr<AnyImex> imex(const Scene& scene, double step, std::function<double(Index)> share,
                              int threads) {
    const taut::ImexOptions options{step, std::move(share), threads};
    if (scene.kind().laws != Laws::any) return make_imex<Plain<float, 2>, Planar>(scene, options);
    return scene.dim() == 3 ? imex_of_laws_in_3d(scene, options) : imex_of_laws(scene, options);
}

std::unique_ptr<AnyStepper> imex_of_view(const Scene& scene, double step) {
    std::unique_ptr<AnyStepper> made;
    visit_system<Planar>(
        scene, [&](const Planar& system) { made = std::make_unique<ImexOfView>(system, step); });
    return made;
}

}  // namespace taut_test
