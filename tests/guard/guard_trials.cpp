// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "guard_on.hpp"

namespace taut_test {

namespace {

/// A user's trial: it keeps what the guard refers to.
template <class System>
struct TrialOn {
    Trial trial;
    bool operator()(typename System::State& state, typename System::Scalar h) const {
        return call_any(trial, state, static_cast<double>(h));
    }
};
template <class System>
class TrialGuard : private TrialOn<System>,
                   public GuardOn<TrialOn<System>, System, System::Dim == 3> {
public:
    TrialGuard(const System& system, Trial of)
        : TrialOn<System>{std::move(of)},
          GuardOn<TrialOn<System>, System, System::Dim == 3>(
              system, static_cast<TrialOn<System>&>(*this)) {}
};

}  // namespace

std::unique_ptr<AnyGuard> guarded(const Scene& scene, Trial trial) {
    std::unique_ptr<AnyGuard> made;
    visit_system<Plain<float, 1>, Plain<double, 1>, Plain<float, 2>, Strings<double, 2>,
                 Strings<float, 3>, Strings<double, 3>, AnyLaw<double, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            made = std::make_unique<TrialGuard<System>>(system, std::move(trial));
        });
    return made;
}

}  // namespace taut_test
