// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "../core/error.hpp"
#include "../core/types.hpp"

namespace taut {

/// What sets a step limit, or removes it.
enum class Cause {
    stiffness,         ///< the stiffest mode
    damping,           ///< damping too strong for the step
    undamped,          ///< explicit Euler without damping
    undamped_modes,    ///< explicit Euler: some stiffness has no damping beside it
    unconditional,     ///< implicit Euler: every step is stable
    nothing_to_limit,  ///< no free particle, or neither stiffness nor damping
    buckling,          ///< K is indefinite: the physics itself grows, at growth_rate
    damping_unproved,  ///< D could not be shown to be positive semi-definite
    rounding,          ///< semi-definiteness was shown up to rounding only: see certified_up_to
    overflow,          ///< values beyond the range of double: nothing is proved
    one_pose_only      ///< explicit Euler, of which no step is proved at every pose
};

/// The name as the programs and their JSON spell it.
constexpr const char* name(Cause cause) {
    switch (cause) {
        case Cause::stiffness: return "stiffness";
        case Cause::damping: return "damping";
        case Cause::undamped: return "undamped";
        case Cause::undamped_modes: return "undamped_modes";
        case Cause::unconditional: return "unconditional";
        case Cause::nothing_to_limit: return "nothing_to_limit";
        case Cause::buckling: return "buckling";
        case Cause::damping_unproved: return "damping_unproved";
        case Cause::rounding: return "rounding";
        case Cause::overflow: return "overflow";
        case Cause::one_pose_only: return "one_pose_only";
    }
    return "unknown";
}

/// One sentence for people: the cause, and the cure where one is needed.
constexpr const char* describe(Cause cause) {
    switch (cause) {
        case Cause::stiffness: return "the stiffest mode sets the limit";
        case Cause::damping: return "the damping sets the limit: less of it allows a larger step";
        case Cause::undamped:
            return "no step is stable without damping: add Rayleigh damping, or use symplectic or "
                   "implicit Euler";
        case Cause::undamped_modes:
            return "some stiffness has no damping beside it, so no step can be certified: add "
                   "mass-proportional damping d0, or use symplectic or implicit Euler";
        case Cause::unconditional: return "stable at every step";
        case Cause::nothing_to_limit:
            return "nothing limits the step: no particle is free, or none is pulled or damped";
        case Cause::buckling:
            return "compressed springs make the physics itself unstable: the limit is the step's "
                   "own, and growth_rate is what no step size removes; relax the compression, or "
                   "pin";
        case Cause::damping_unproved:
            return "the damping matrix could not be shown to be positive semi-definite: no step is "
                   "certified; check its sign, or give dampers as springs";
        case Cause::one_pose_only:
            return "no step of explicit Euler is proved at every pose: ask Stability about one "
                   "pose, or use symplectic or implicit Euler";
        case Cause::overflow:
            return "the numbers of this scene are beyond the range of double, so nothing is "
                   "proved: "
                   "check the units of its stiffness, masses and damping";
        case Cause::rounding:
            return "a matrix could be shown to be positive semi-definite only up to rounding, so "
                   "slow growth is not excluded: certified_up_to is safe but for admitted_growth; "
                   "give "
                   "the scene as springs to have it exact";
    }
    return "unknown cause";
}

/// The largest stable step as a bracket [certified, refuted): the true limit lies between.
template <class Scalar>
struct StepLimit {
    Scalar certified = 0;  ///< s; proved: every h in (0, certified] is stable (0: none is proved;
                           ///< infinity: every step is)
    Scalar refuted = 0;    ///< s; a vector proves that this step fails (infinity: none is known to)
    Cause cause = Cause::stiffness;
    Scalar estimate = 0;  ///< s; explicit Euler under dampers, where a tightness was asked for: a
                          ///< numerical guess at the limit
                          ///< where the bracket is wide; safe for nothing (0: none)
    double growth_rate = 0;  ///< 1/s; √κ of the physics when K has the eigenvalue −κ, else 0
    Scalar certified_up_to = 0;  ///< s; where semi-definiteness could be shown only up to rounding:
                                 ///< up to this step nothing grows faster than admitted_growth
    double admitted_growth = 0;  ///< 1/s
    std::uint64_t revision = 0;  ///< of the system that was analysed

    /// Whether every step is certified.
    bool unbounded() const { return !detail::is_finite(certified); }

    /// safety·certified, or nothing when the system has changed since the analysis, when no step is
    /// certified, or when safety is not in (0, 1].
    template <class System>
    std::optional<Scalar> step_for(const System& system, Scalar safety) const {
        if (system.revision() != revision || !(certified > 0)) return std::nullopt;
        if (!(safety > 0) || safety > 1 || !detail::is_finite(safety)) return std::nullopt;
        return safety * certified;
    }

    /// The fewest equal steps of a frame, s, that are safety·certified at most; nothing when no
    /// step is certified, or when safety is not in (0, 1]. Fails unless frame is finite and > 0.
    std::optional<Index> substeps(double frame, double safety = 0.95) const {
        require_positive("StepLimit::substeps", "frame", frame);
        const bool usable = safety > 0 && safety <= 1 && detail::is_finite(safety);
        if (!usable || !(certified > 0)) return std::nullopt;
        const double steps = frame / (safety * static_cast<double>(certified));
        if (!(steps < 1e15)) return std::nullopt;  // no longer exact, and no frame was meant
        return std::max<Index>(1, static_cast<Index>(std::ceil(steps)));
    }
};

namespace proof_detail {

/// By how much, relative, rounding in any direction may move a limit: the arithmetic in double that
/// made it, and what a stepper holds as Scalars, 1/m, d0, α and two products of these (3 ulp).
template <class Scalar>
inline constexpr double step_rounding =
    8 * std::numeric_limits<double>::epsilon() +
    4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());

/// The largest Scalar ≤ value, which first loses what rounding may have added.
template <class Scalar>
Scalar round_down(double value) {
    if (!detail::is_finite(value)) {  // no number proves nothing
        return detail::is_finite(std::nextafter(value, 0.0)) ? static_cast<Scalar>(value) : 0;
    }
    value = (std::min)(value - step_rounding<Scalar> * value,
                       static_cast<double>((std::numeric_limits<Scalar>::max)()));
    const Scalar rounded = static_cast<Scalar>(value);
    return static_cast<double>(rounded) <= value ? rounded : std::nextafter(rounded, Scalar(0));
}

/// The smallest Scalar ≥ value, with the same allowance.
template <class Scalar>
Scalar round_up(double value) {
    const auto most = static_cast<double>((std::numeric_limits<Scalar>::max)()) / 2;
    if (!detail::is_finite(value) || value > most) return std::numeric_limits<Scalar>::infinity();
    value += step_rounding<Scalar> * value;
    const Scalar rounded = static_cast<Scalar>(value);
    return static_cast<double>(rounded) >= value
               ? rounded
               : std::nextafter(rounded, std::numeric_limits<Scalar>::infinity());
}

/// A step limit in double, before it is rounded to a system's Scalar: see StepLimit for the fields.
struct UnroundedLimit {
    double certified = 0;                                      ///< s
    double refuted = std::numeric_limits<double>::infinity();  ///< s
    Cause cause = Cause::stiffness;
    double estimate = 0;         ///< s; 0: none
    double growth_rate = 0;      ///< 1/s
    double certified_up_to = 0;  ///< s, but for admitted_growth
    double admitted_growth = 0;  ///< 1/s
};

/// Whether it says of any step that it is safe, if only but for admitted_growth.
inline bool claims(const UnroundedLimit& limit) {
    return limit.certified > 0 || limit.certified_up_to > 0;
}

/// What no Scalar holds claims nothing.
template <class Scalar>
void forget_unheld(UnroundedLimit& limit) {
    for (double* step : {&limit.certified, &limit.certified_up_to}) {
        if (round_down<Scalar>(*step) == 0) *step = 0;
    }
}

/// The limit as Scalars that claim no more. @param revision  of the system that was analysed
template <class Scalar>
StepLimit<Scalar> rounded(const UnroundedLimit& limit, std::uint64_t revision) {
    StepLimit<Scalar> answer;
    answer.certified = round_down<Scalar>(limit.certified);
    answer.refuted = round_up<Scalar>(limit.refuted);
    answer.cause = limit.cause;
    // Nothing found is no estimate, and none lies where a vector refutes.
    if (limit.estimate > 0 && detail::is_finite(limit.estimate)) {
        answer.estimate = (std::min)(static_cast<Scalar>(limit.estimate), answer.refuted);
    }
    answer.growth_rate = limit.growth_rate;
    answer.certified_up_to = round_down<Scalar>(limit.certified_up_to);
    answer.admitted_growth = limit.admitted_growth;
    answer.revision = revision;
    return answer;
}

}  // namespace proof_detail
}  // namespace taut
