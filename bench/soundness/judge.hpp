// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <taut/conditions/visit.hpp>
#include <taut/proof/any_pose.hpp>
#include <taut/proof/energy_limit.hpp>
#include <taut/proof/bracket.hpp>
#include <taut/proof/sharp_limit.hpp>
#include <taut/tight/tight.hpp>

#include "claims.hpp"
#include "random_scene.hpp"

// Every limit of one system, asked for and judged.

namespace soundness {

using taut::Method;

// h, s, was called safe; or there is a vector that proves it is not: by what limits the method.
inline Verdict certified_by(taut::method::LimitedByDamping, const Exact& e, double h,
                            double admitted) {
    return std::isinf(h) ? certified_always_explicit(e) : certified_explicit(e, h, admitted);
}
inline Verdict certified_by(taut::method::LimitedByStiffness, const Exact& e, double h, double) {
    return std::isinf(h) ? certified_always(e) : certified_symplectic(e, h);
}
inline Verdict certified_by(taut::method::LimitedByIndefiniteness, const Exact& e, double h,
                            double) {
    return std::isinf(h) ? Verdict::holds : certified_implicit(e, h);
}
inline Verdict refuted_by(taut::method::LimitedByDamping, const Exact& e, const Real& h) {
    return refuted_explicit(e, h);
}
inline Verdict refuted_by(taut::method::LimitedByStiffness, const Exact& e, const Real& h) {
    return refuted_symplectic(e, h);
}
inline Verdict refuted_by(taut::method::LimitedByIndefiniteness, const Exact& e, const Real& h) {
    return refuted_implicit(e, h);
}

/// What was claimed how often, and what of it is false.
struct Tally {
    struct Count {
        int judged = 0;
        int wrong = 0;
        int unknown = 0;
    };
    std::map<std::string, Count> claims;
    std::string scene;  ///< what is judged now, for messages
    int wrong = 0;

    void add(const std::string& claim, double value, Verdict verdict) {
        Count& count = claims[claim];
        ++count.judged;
        count.unknown += verdict == Verdict::unknown;
        if (verdict != Verdict::wrong) return;
        ++count.wrong;
        ++wrong;
        std::printf("FALSE: %s: %s %.17g\n", scene.c_str(), claim.c_str(), value);
        std::fflush(stdout);
    }
};

/// One system. With springs near a kink there are more: what is certified must hold for all, what
/// is refuted for one of these or of those that are `near`.
class Judge {
public:
    Judge(Tally& tally, std::vector<Exact> sides, std::vector<Exact> near = {})
        : tally_(tally), sides_(std::move(sides)), near_(std::move(near)) {}

    /// @param label  which answer this is, as "symplectic, by bounds"
    template <class Scalar>
    void limit(Method method, const std::string& label, const taut::StepLimit<Scalar>& limit) {
        const auto certified = static_cast<double>(limit.certified);
        const auto refuted = static_cast<double>(limit.refuted);
        const auto up_to = static_cast<double>(limit.certified_up_to);
        const double admitted = limit.admitted_growth;
        if (certified > 0) {
            certifies(method, label + ": certified", certified, 0);
            if (method != Method::explicit_euler) {
                holds(label + ": D is semi-definite", certified,
                      [&](const Exact& e) { return no_faster_feeding(e, 0); });
            }
        }
        if (up_to > 0) {
            certifies(method, label + ": certified up to", up_to, admitted);
            if (method != Method::explicit_euler) {
                holds(label + ": no faster feeding", admitted,
                      [&](const Exact& e) { return no_faster_feeding(e, admitted); });
            }
        }
        if ((certified > 0 || up_to > 0) && limit.growth_rate == 0) {
            holds(label + ": no faster growth", admitted,
                  [&](const Exact& e) { return no_faster_growth(e, admitted); });
        }
        if (limit.growth_rate > 0) possible(label + ": buckles", limit.growth_rate, &buckles);
        if (std::isfinite(refuted)) {
            possible(label + ": refuted", refuted, [&](const Exact& e) {
                const Real h = refuted > 0 ? Real(refuted) : tiny_step(e);
                return taut::method::visit_limited("Judge", method, [&](auto descriptor) {
                    return refuted_by(typename decltype(descriptor)::Limit{}, e, h);
                });
            });
        }
    }
    /// Of EnergyStableEuler [T42]: of the Laplacians.
    template <class Scalar>
    void energy_stable(const std::string& label, const taut::StepLimit<Scalar>& limit) {
        const auto certified = static_cast<double>(limit.certified);
        const auto refuted = static_cast<double>(limit.refuted);
        if (certified > 0) {
            holds(label + ": certified", certified, [&](const Exact& e) {
                return std::isinf(certified) ? certified_always(e)
                                             : certified_energy_stable(e, certified);
            });
        }
        if (std::isfinite(refuted) && refuted > 0) {
            possible(label + ": refuted", refuted,
                     [&](const Exact& e) { return refuted_energy_stable(e, refuted); });
        }
    }
    /// h, s, was called safe.
    void certifies(Method method, const std::string& claim, double h, double admitted) {
        holds(claim, h, [&](const Exact& e) {
            return taut::method::visit_limited("Judge", method, [&](auto descriptor) {
                return certified_by(typename decltype(descriptor)::Limit{}, e, h, admitted);
            });
        });
    }
    void spectrum(const taut::StiffnessSpectrum& spectrum) {
        // λ_max(M⁻¹K⁺) ≤ upper, and so on.
        const auto beyond = [&](const Real& k, int sign) {
            return [k, sign](const Exact& e) {
                return wrong_if(negative(Sum(e).mass(sign * k).projected(-sign).matrix()));
            };
        };
        const auto within = [&](const Real& k, int sign) {
            return [k, sign](const Exact& e) {
                return positive(Sum(e).mass(sign * k).projected(-sign).matrix()) ? Verdict::wrong
                                                                                 : Verdict::holds;
            };
        };
        if (std::isfinite(spectrum.k_max.upper))
            holds("k_max: upper", spectrum.k_max.upper, beyond(spectrum.k_max.upper, 1));
        if (spectrum.k_max.lower > 0)
            possible("k_max: lower", spectrum.k_max.lower, within(spectrum.k_max.lower, 1));
        if (std::isfinite(spectrum.k_min.lower))
            holds("k_min: lower", spectrum.k_min.lower, beyond(spectrum.k_min.lower, -1));
        if (std::isfinite(spectrum.k_min.upper))
            possible("k_min: upper", spectrum.k_min.upper, within(spectrum.k_min.upper, -1));
    }
    /// D = d0·M + αK⁺ was said to make step h stable.
    void window(Method method, double h, double d0, double alpha) {
        for (Exact e : sides_) {
            e.d0 = d0;
            e.alpha = alpha;
            e.dampers = Rounded(e.size());
            // Without springs a K that is not semi-definite makes such a D none either.
            if (!e.springs && negative(Sum(e).stiffness(1).matrix()) != Answer::no) return;
            Judge(tally_, {e})
                .certifies(
                    method,
                    method == Method::explicit_euler ? "explicit: window" : "symplectic: window", h,
                    0);
        }
    }

private:
    /// Must hold on both sides of a kink.
    template <class Check>
    void holds(const std::string& claim, double value, const Check& check) {
        Verdict verdict = Verdict::holds;
        for (const Exact& e : sides_) verdict = both(verdict, check(e));
        tally_.add(claim, value, verdict);
    }
    /// Must hold on one.
    template <class Check>
    void possible(const std::string& claim, double value, const Check& check) {
        Verdict verdict = Verdict::wrong;
        for (const auto* systems : {&sides_, &near_}) {
            for (const Exact& e : *systems) {
                if (verdict == Verdict::holds) break;
                const Verdict here = check(e);
                if (here != Verdict::wrong) verdict = here;
            }
        }
        tally_.add(claim, value, verdict);
    }
    /// Far below every frequency: "no step is stable" must be true of it.
    static Real tiny_step(const Exact& e) {
        Real fastest = 0;
        for (int i = 0; i < e.size(); ++i) {
            fastest = std::max(fastest, Real(e.K.magnitude(i, i) / e.mass[i]));
        }
        return fastest == 0 ? Real(1) : scaled(Real(1 / sqrt(fastest)), -80);
    }

    Tally& tally_;
    std::vector<Exact> sides_;
    std::vector<Exact> near_;
};

/// Asks for every limit of Stability, by bounds and by factorisations, and judges it.
template <class Scalar>
void judge_stability(Draw& draw, Judge& judge, const taut::Stability<Scalar>& stability) {
    const double tightness = std::exp2(draw.uniform(-20, -3));
    for (const Method method :
         {Method::symplectic_euler, Method::explicit_euler, Method::implicit_euler}) {
        const std::string label = taut::name(method);
        const auto bound = taut::bracket(stability, method);
        const auto narrow = taut::max_step(stability, method, tightness);
        judge.limit(method, label + ", by bounds", bound);
        judge.limit(method, label + ", narrowed", narrow);
        const auto from = static_cast<double>(bound.certified);
        const auto to = static_cast<double>(bound.refuted);
        const double h = draw.one_in(4) ? std::nextafter(static_cast<double>(narrow.refuted), 0)
                         : from > 0     ? from * draw.uniform(1, 3)
                         : std::isfinite(to) ? to * draw.uniform(0.3, 1)
                                             : 1;
        if (h > 0 && std::isfinite(h) && taut::certify(stability, method, h).proved)
            judge.certifies(method, label + ", certify: proved", h, 0);
    }
    const auto spectrum = taut::stiffness_spectrum(stability);
    judge.spectrum(spectrum);
    const double k = spectrum.k_max.upper;
    const double h = draw.uniform(0.01, 1) * 2 / std::sqrt(k);
    if (!(k > 0) || !(h > 0) || !std::isfinite(h)) return;
    for (const Method method : {Method::symplectic_euler, Method::explicit_euler}) {
        const double d0 = draw.one_in(3)   ? 0
                          : draw.one_in(2) ? draw.uniform(0, 2) / h
                                           : (2 - std::exp2(draw.uniform(-60, -4))) / h;
        const auto window = stability.rayleigh_window(method, h, d0);
        for (const double alpha :
             {std::nextafter(window.lower, window.upper),
              std::nextafter(window.upper, window.lower), (window.lower + window.upper) / 2}) {
            if (window.contains(alpha)) judge.window(method, h, d0, alpha);
        }
    }
}

/// One scene at one pose.
template <class System>
void judge_pose(Draw& draw, Tally& tally, const Scene<System>& scene) {
    const auto& [system, state] = scene;
    const taut::Stability<typename System::Scalar> stability(system, state);
    if (stability.size() == 0) return;
    const auto side = [&s = system, &x = state.x](bool stiffer, double reach) {
        return [&s, &x, which = Side{stiffer, reach}] { return exact_at_pose(s, x, which); };
    };
    // The library counts both sides of a kink within a reach of 8.
    const auto all =
        in_enough_bits({side(true, 6), side(false, 6), side(true, 12), side(false, 12)});
    std::vector<Exact> sides, near;
    for (const Exact& e : all) {
        const bool inside = &e - all.data() < 2;
        if (inside && (sides.empty() || e.moved)) sides.push_back(e);
        if (!inside && e.moved) near.push_back(e);
    }
    if (all.front().kinked || all[1].kinked) tally.scene += ", at a kink";
    Judge judge(tally, sides, near);
    judge_stability(draw, judge, stability);
    const auto any = taut::any_pose_bracket(system);
    const auto narrow = taut::any_pose_limit(system, std::exp2(draw.uniform(-20, -3)));
    // What holds at every pose holds at this one.
    for (const auto& limit : {any, narrow}) {
        if (limit.certified > 0)
            judge.certifies(Method::symplectic_euler, "any pose, at this one: certified",
                            static_cast<double>(limit.certified), 0);
    }
    Judge laplacians(tally, in_enough_bits({[&s = system] { return exact_laplacians(s); }}));
    laplacians.limit(Method::symplectic_euler, "any pose, by bounds", any);
    laplacians.limit(Method::symplectic_euler, "any pose, narrowed", narrow);
    laplacians.limit(Method::symplectic_euler, "any pose, sharpened",
                     taut::sharp_any_pose_limit(system));
    laplacians.energy_stable("energy stable", taut::energy_bracket(system));
    laplacians.energy_stable("energy stable, sharpened", taut::sharp_energy_limit(system));
}

/// A random scene; some of them again with the stiffest mode as near to critical damping,
/// (d0 + αk)² = 4k, as double can tell: there the explicit limit moves by the root of all rounding.
template <class System>
void judge_springs(Draw& draw, Tally& tally) {
    auto scene = random_scene<System>(draw);
    judge_pose(draw, tally, scene);
    if (!draw.one_in(8)) return;
    const taut::Stability<typename System::Scalar> stability(scene.system, scene.state);
    const auto [lower, upper] = taut::stiffness_spectrum(stability).k_max;
    const double k = draw.one_in(2) ? lower : upper;
    if (!(k > 0) || !std::isfinite(k)) return;
    const double d0 = draw.one_in(3) ? 0 : draw.uniform(0, 2) * std::sqrt(k);
    const double alpha = (2 * std::sqrt(k) - d0) / k;
    scene.system.set_rayleigh({d0, alpha * (1 + (draw.uniform(-4, 4) * 0x1p-52))});
    tally.scene += ", critically damped";
    judge_pose(draw, tally, scene);
}

template <class Scalar>
void judge_matrices(Draw& draw, Tally& tally, const taut::LinearSystem<Scalar>& system) {
    Judge judge(tally, in_enough_bits({[&system] { return exact_matrices(system); }}));
    judge_stability(draw, judge, taut::Stability<Scalar>(system));
}

}  // namespace soundness
