// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Tries to break what Guarded promises [T43]: scenes, trial steppers, frames, outside forces,
// moving pins, contacts and edits are decoded from the input. Energies are measured apart from the
// guard.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <taut/bdf2/bdf2.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "../bench/guard/books.hpp"
#include "soup.hpp"

namespace {

using guard_books::Books;
using guard_books::Real;
using taut::Index;
using taut_fuzz::Bytes;
using taut_fuzz::require;

/// 1/16 … 16, N or N per unit.
template <class Scalar>
Scalar moderate(Bytes& bytes) {
    return static_cast<Scalar>(std::exp2(bytes.byte() / 32.0 - 4));
}

/// An outside force of which nothing is stiff beyond the halvings, or anything.
template <class System>
void set_force(System& system, Bytes& bytes) {
    using Scalar = typename System::Scalar;
    const int kind = bytes.byte() % 8;
    const Scalar strength =
        bytes.one_in(2) ? moderate<Scalar>(bytes) : static_cast<Scalar>(bytes.positive());
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
    } else if (kind == 4 && system.size() > 0) {
        const Index which = bytes.below(system.size());
        const auto force = taut_fuzz::place<Scalar, System::Dim>(bytes);
        taut_fuzz::accepted([&] { system.set_constant_force(which, force); });
    }
}

/// Whether nothing can leave the range of Scalar in a frame: energies, squares of ways and speeds,
/// and what is divided by.
template <class System>
bool is_tame(const System& system, const typename System::State& state, Real frame) {
    using Scalar = typename System::Scalar;
    typename System::Force f(int(System::Dim), system.size());
    f.setZero();
    system.external_force(state, f);
    if (!state.finite() || !f.allFinite()) return false;
    Real lightest = std::numeric_limits<Real>::infinity(), heaviest = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        lightest = std::min(lightest, Real(system.mass(i)));
        heaviest = std::max(heaviest, Real(system.mass(i)));
    }
    if (heaviest == 0) return false;
    const Books books = guard_books::books_of(system, state);
    const Real push = f.size() == 0 ? Real(0) : Real(f.cwiseAbs().maxCoeff());
    const Real pull = Real(system.gravity().norm()) + push / lightest;
    const Real pin = state.v.size() == 0 ? Real(0) : Real(state.v.cwiseAbs().maxCoeff());
    const Real speed = std::sqrt(2 * books.size / lightest) + 4 * pull * frame + pin;
    const Real reach = Real(state.x.cwiseAbs().maxCoeff()) + speed * frame;
    Real stiffest = 0, longest = 0;
    system.visit_springs([&](const auto& spring) {
        stiffest = std::max({stiffest, Real(spring.stiffness_bound()), Real(spring.damping)});
        longest = std::max(longest, Real(spring.rest_length));
    });
    const Real way = reach + longest;
    const Real most = std::pow(Real(std::numeric_limits<Scalar>::max()), Real(0.8));
    const Real least = 1 / most;
    for (const Real large :
         {way * way, speed * speed, heaviest * speed * speed, heaviest * pull * way,
          stiffest * way * way, stiffest * way * speed, stiffest / lightest, 1 / lightest, frame}) {
        if (!(large < most)) return false;
    }
    return frame > least && lightest > least;
}

/// What of the work of forces given as code, and of moving pins, rounding may hide beside ρ, in
/// units of the roundoff, J.
template <class System>
double outside_size(const System& system, const typename System::State& state, double frame,
                    double steps) {
    using Scalar = typename System::Scalar;
    typename System::Force f(int(System::Dim), system.size());
    f.setZero();
    system.external_force(state, f);
    double sum = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        sum += steps * double(f.col(i).norm()) * double(state.x.col(i).norm());
    }
    system.visit_springs([&](const auto& spring) {
        const double speed =
            std::max(system.is_pinned(spring.a) ? double(state.v.col(spring.a).norm()) : 0.0,
                     system.is_pinned(spring.b) ? double(state.v.col(spring.b).norm()) : 0.0);
        const auto a = state.x.col(spring.a), b = state.x.col(spring.b);
        const double reach = double(a.norm()) + double(b.norm()) + double(spring.rest_length);
        // The direction of one that is as short as the rounding of its ends is that rounding.
        const Scalar l = taut::spring_length((b - a).eval());
        const double damper = double(spring.damping) + system.rayleigh().stiffness_proportional *
                                                           double(spring.stiffness_bound());
        const double force =
            std::abs(double(spring.tension(l))) +
            damper * double((state.v.col(spring.b) - state.v.col(spring.a)).norm());
        const double turned =
            force *
            std::min(reach / double(l), 1.0 / double(std::numeric_limits<Scalar>::epsilon()));
        sum += (double(spring.stiffness_bound()) * reach + turned) * speed * frame;
    });
    return sum;
}

/// What is done to a scene between two frames.
template <class System>
void edit(System& system, typename System::State& state, Bytes& bytes) {
    using Scalar = typename System::Scalar;
    if (system.size() == 0) return;
    const Index which = bytes.below(system.size());
    const Index springs = system.spring_count();
    switch (bytes.byte() % 8) {
        case 0: system.pin(which); break;
        case 1: system.unpin(which); break;
        case 2:
            if (springs > 0) system.remove_spring(bytes.below(springs));
            break;
        case 3: {
            using Law = typename System::FirstLaw;
            taut::Spring<Scalar, Law> spring{which, bytes.below(system.size()),
                                             taut_fuzz::parameters<Scalar>(bytes, Law{}),
                                             moderate<Scalar>(bytes)};
            taut_fuzz::accepted([&] { system.add_spring(spring); });
            break;
        }
        case 4: system.set_mass(which, moderate<Scalar>(bytes)); break;
        case 5: system.set_gravity(taut_fuzz::place<Scalar, System::Dim>(bytes)); break;
        default: state.v.col(which) = taut_fuzz::place<Scalar, System::Dim>(bytes);
    }
}

/// A trial that is as wrong as the input says.
template <class System>
struct Spoiler {
    using Scalar = typename System::Scalar;
    const System& system;
    Bytes& bytes;
    taut::VelocityVerlet<System> verlet;

    Spoiler(const System& given, Bytes& input) : system(given), bytes(input), verlet(given) {}
    bool operator()(typename System::State& state, Scalar h) {
        const Scalar limit = taut::any_pose_limit(system).certified;
        const auto count = static_cast<Index>(std::ceil(std::min(Scalar(50), h / limit)));
        const bool taken = count > 0 && verlet.step(state, h / static_cast<Scalar>(count), count);
        const int kind = bytes.byte() % 8;
        if (system.size() == 0) return taken;
        const Index which = bytes.below(system.size());
        if (kind == 0) state.v.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        if (kind == 1) state.v *= moderate<Scalar>(bytes);
        if (kind == 2) state.x.col(which) += taut_fuzz::place<Scalar, System::Dim>(bytes);
        if (kind == 3) state.v.col(which).setConstant(std::numeric_limits<Scalar>::max());
        if (kind == 4) return false;
        return taken;
    }
};

template <class Guarded, class System>
void advance_frames(Guarded& guard, System& system, typename System::State state, Bytes& bytes) {
    using Scalar = typename System::Scalar;
    constexpr double unit = std::numeric_limits<Scalar>::epsilon() / 2;
    const double speed_up = std::exp2(bytes.byte() / 32.0 - 2);
    const bool respond = bytes.one_in(4);
    const bool by_code = system.has_external_force();
    Books last = guard_books::books_of(system, state);
    guard_books::Promise promise(unit, last);
    const int frames = 4 + bytes.byte() % 60;
    for (int i = 0; i < frames; ++i) {
        if (bytes.one_in(8)) {
            edit(system, state, bytes);
            const Books edited = guard_books::books_of(system, state);
            promise.edit(last, edited);
            last = edited;
        }
        // Not so long that it is taken again in millions of steps.
        const double limit = taut::any_pose_limit(system).certified;
        const double proved = taut::energy_limit(system).certified;
        const double frame = std::min(
            {speed_up * (1 + bytes.byte() % 3) * limit, 300 * proved, limit > 0 ? 1.0 / 60 : 0.0});
        const bool tame = proved > 1e-25 && is_tame(system, state, frame);
        const auto before = state;
        const auto advance = [&] {
            if (!respond) return guard.advance(state, static_cast<Scalar>(frame));
            return guard.advance(state, static_cast<Scalar>(frame), [](auto& s) {
                for (Index p = 0; p < s.x.cols(); ++p) {
                    if (s.x(0, p) < -4) s.v(0, p) = std::max(s.v(0, p), Scalar(0));
                }
            });
        };
        const auto report = advance();
        const bool refused = !report && report.status != taut::Status::frozen;
        if (refused) {
            require(taut_fuzz::same(state, before), "a refused frame leaves the state as it was");
            require(report.advanced == 0, "a refused frame advances nothing");
            require(!tame, "no frame is refused while what is given is finite");
            continue;
        }
        require(state.finite(), "an accepted frame is finite");
        require(report || by_code, "only a force given as code freezes a part");
        const Books now = guard_books::books_of(system, state);
        if (!std::isfinite(report.energy) || !std::isfinite(report.work) ||
            !std::isfinite(report.slack) || !tame)
            return;
        require(report.spring == -1, "no law exceeds its bound");
        const double steps = std::max(static_cast<double>(report.substeps), 4 * frame / proved);
        const double unseen = 8 * unit *
                              std::max(outside_size(system, before, frame, steps),
                                       outside_size(system, state, frame, steps));
        require(promise.keeps(now, report, unseen, by_code), "E ≤ E + 0.1 K + ΣW + d");
        require(std::abs(report.energy - now.energy) <= 16 * unit * now.size + now.hidden,
                "the report's energy is that of the state");
        bool moves = false;
        for (Index p = 0; p < system.size(); ++p)
            moves = moves || (system.is_pinned(p) && !state.v.col(p).isZero(0));
        require(by_code || respond || moves || report.work == 0, "nothing works from outside");
        last = now;
    }
}

/// @tparam Steppers  of which the input chooses one, beside a trial that spoils its frames
template <class System, class... Steppers>
void guard_scene(Bytes bytes) {
    auto system = taut_fuzz::decode_system<System>(bytes);
    const auto state = taut_fuzz::decode_state(bytes, system);
    const int chosen = bytes.byte() % static_cast<int>(sizeof...(Steppers) + 1);
    set_force(system, bytes);
    taut::GuardedOptions<typename System::Scalar> options;
    options.max_substeps = 1 + bytes.byte() % 64;
    if (chosen == static_cast<int>(sizeof...(Steppers))) {
        Spoiler<System> spoiler(system, bytes);
        taut::Guarded guard(system, spoiler, options);
        taut_fuzz::accepted([&] { advance_frames(guard, system, state, bytes); });
        return;
    }
    int index = 0;
    const auto run = [&](auto guard) { advance_frames(guard, system, state, bytes); };
    taut_fuzz::accepted([&] {
        ((index++ == chosen ? run(taut::Guarded<Steppers>(system, options)) : void()), ...);
    });
}

using Springs = taut::SpringSystem<double, 2>;
using Cloth = taut::SpringSystem<double, 3, taut::TensionOnly, taut::Buckling>;
using Small = taut::SpringSystem<float, 2, taut::TensionOnly>;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    switch (bytes.byte() % 4) {
        case 0: guard_scene<Cloth, taut::VelocityVerlet<Cloth>>(bytes); break;
        case 1:
            guard_scene<Small, taut::VelocityVerlet<Small>, taut::SymplecticEuler<Small>>(bytes);
            break;
        default:
            guard_scene<Springs, taut::VelocityVerlet<Springs>, taut::SymplecticEuler<Springs>,
                        taut::ImplicitEuler<Springs>, taut::Bdf2<Springs>>(bytes);
    }
    return 0;
}
