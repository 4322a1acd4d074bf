// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Tries to break what an accepted frame of Guarded promises [T36]: scenes, methods, frames, outside
// forces, moving pins, contacts and edits are decoded from the input.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <taut/bdf2/bdf2.hpp>
#include <taut/model/buckling.hpp>
#include <taut/model/tension_only.hpp>

#include "soup.hpp"

namespace {

using taut_fuzz::Bytes;
using taut_fuzz::require;

/// An outside force: none, constant, a floor, a drag, or a pulse.
template <class System>
void set_force(System& system, Bytes& bytes) {
    using Scalar = typename System::Scalar;
    const int kind = bytes.byte() % 8;
    const auto strength = static_cast<Scalar>(bytes.positive());
    if (kind == 0) {
        system.set_external_force([=](const auto&, auto& f) { f.row(0).array() += strength; });
    } else if (kind == 1) {
        system.set_external_force(
            [=](const auto& s, auto& f) { f.row(0) -= strength * s.x.row(0).cwiseMin(Scalar(0)); });
    } else if (kind == 2) {
        system.set_external_force([=](const auto& s, auto& f) { f -= strength * s.v; });
    } else if (kind == 3) {
        system.set_external_force(
            [=](const auto& s, auto& f) { f.row(0).array() += strength * std::sin(100 * s.time); });
    }
}

/// The inequality of Guarded's docstring, as small as any earlier frame makes it.
struct Promise {
    double swing;  // C
    double yield;  // w
    double slack;
    double drift;
    double granted = 0;
    double scale = 0;
    double rounding = 0;  // of the last frame's end

    void open(const taut::integrator_detail::EnergyBooks& books) {
        granted = swing * books.owned();
        rounding = books.rounding;
    }
    /// Whoever touches the scene changes E by so much.
    void touch(double before, const taut::integrator_detail::EnergyBooks& books) {
        granted += swing * std::abs(books.owned() - before);
        rounding = books.rounding;
    }
    /// @param work  gravity's included, as kept energy counts it, J
    void check(double start, double fallen, const taut::integrator_detail::EnergyBooks& books,
               double work, double outside, double span) {
        scale = std::max(scale, start + std::max(0.0, fallen) + std::abs(outside));
        granted += yield * work;
        const double most = granted + yield * (slack * scale + rounding + books.rounding);
        const double grain = 1e-9 * (std::abs(granted) + scale + yield * std::abs(work));
        require(!(books.owned() > most + grain), "an accepted frame keeps its promise");
        granted = std::min(granted + yield * drift * span * scale, swing * books.owned());
        rounding = books.rounding;
    }
};

template <class Stepper, class System>
void run_guard(System& system, typename System::State state, Bytes& bytes) {
    using Scalar = typename System::Scalar;
    using Guard = taut::Guarded<Stepper>;
    typename Guarded::Options options;
    options.max_substeps = 40;
    options.max_retries = 3;
    options.max_step = static_cast<Scalar>(bytes.positive());
    Guarded guard(system, options);
    constexpr taut::Method method = Guarded::method;
    Promise promise{1, 1, options.energy_slack, options.energy_drift};
    if (method == taut::Method::symplectic_euler) {
        promise.swing = 3.5;
        promise.yield = 2.4;
    } else if (method == taut::Method::velocity_verlet) {
        promise.swing = 2.3;
        promise.yield = 2;
    }
    typename System::Force f;
    taut::integrator_detail::PinWork<System> pins;
    const auto books = [&] {
        return taut::integrator_detail::energy_books(system, state, Guarded::method, pins, f);
    };
    const auto frame = static_cast<Scalar>(bytes.positive());
    if (!(options.max_step > 0)) return;
    auto last = books();
    promise.open(last);
    double lag = 0;
    bool begun = false;
    const int frames = 4 + bytes.byte() % 60;
    double h = 0;
    for (int i = 0; i < frames; ++i) {
        if (bytes.one_in(16) && system.size() > 0) {
            const taut::Index which = bytes.below(system.size());
            state.v.col(which) = taut_fuzz::place<Scalar, System::Dim>(bytes);
            if (bytes.one_in(2)) system.pin(which);
            const auto touched = books();
            promise.touch(last.owned(), touched);
            lag += touched.lag(method, h) - last.lag(method, h);
            last = touched;
        }
        const auto before = state;
        const auto report = guard.advance(state, frame * Scalar(1 + bytes.byte() % 3));
        if (!report) {
            require(taut_fuzz::same(state, before), "a frame given up leaves the state as it was");
            continue;
        }
        require(state.finite(), "an accepted frame is finite");
        const auto now = books();
        if (!std::isfinite(now.total()) || !std::isfinite(now.rounding)) return;
        h = static_cast<double>(report.h);
        if (!begun) lag = last.lag(method, h);
        begun = true;
        const double fallen = last.gravity - now.gravity;
        promise.check(last.owned(), fallen, now, report.work + fallen + lag - now.lag(method, h),
                      report.work, static_cast<double>(report.advanced));
        lag = now.lag(method, h);
        last = now;
    }
}

/// @tparam Steppers  of which the input chooses one
template <class System, class... Steppers>
void guard_scene(Bytes bytes) {
    auto system = taut_fuzz::decode_system<System>(bytes);
    const auto state = taut_fuzz::decode_state(bytes, system);
    const int chosen = bytes.byte() % static_cast<int>(sizeof...(Steppers));
    set_force(system, bytes);
    int index = 0;
    taut_fuzz::accepted(
        [&] { ((index++ == chosen ? run_guard<Steppers>(system, state, bytes) : void()), ...); });
}

using Springs = taut::SpringSystem<double, 2>;
using Cloth = taut::SpringSystem<double, 3, taut::TensionOnly, taut::Buckling>;
using Small = taut::SpringSystem<float, 2, taut::TensionOnly>;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    switch (bytes.byte() % 4) {
        case 0: guard_scene<Cloth, taut::SymplecticEuler<Cloth>>(bytes); break;
        case 1: guard_scene<Small, taut::VelocityVerlet<Small>>(bytes); break;
        default:
            guard_scene<Springs, taut::SymplecticEuler<Springs>, taut::VelocityVerlet<Springs>,
                        taut::Bdf2<Springs>>(bytes);
    }
    return 0;
}
