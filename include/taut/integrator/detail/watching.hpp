// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../../core/concepts.hpp"

namespace taut::integrator_detail {

template <class Stepper>
using watch_of = decltype(std::declval<Stepper&>().watch(nullptr));

/// Lets a stepper that can show its steps show them to a StepWatch, as long as this lives.
template <class By, class Watch>
class Watching {
public:
    Watching(By& by, Watch* watch) : by_(by) { set(watch); }
    ~Watching() { set(nullptr); }
    Watching(const Watching&) = delete;
    Watching& operator=(const Watching&) = delete;

private:
    void set([[maybe_unused]] Watch* watch) {
        if constexpr (detail::is_detected_v<watch_of, By>) by_.watch(watch);
    }
    By& by_;
};

}  // namespace taut::integrator_detail
