// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include "../../network/hookean.hpp"
#include "../../network/spring_set.hpp"
#include "../../proof/bracket.hpp"

namespace taut {
namespace arrays_detail {

template <class Real>
void require_at_least_0(const char* what, Index i, Real value) {
    if (value >= 0 && detail::is_finite(value)) return;
    fail("check_step: the ", what, " ", i, " is ", value, "; it must be finite and >= 0");
}

template <class T, int Width>
void require_rows(const char* field, const ArrayView<T, Width>& rows, Index count,
                  const char* of_what) {
    if (rows.rows() < 0 || rows.rows() >= count) return;
    fail("check_step: ", field, " has ", rows.rows(), " rows; there are ", count, " ", of_what);
}

/// Checked arrays in the place of a SpringSystem, as far as Pencil reads one.
template <class Scalar_, int Dim_>
class System {
public:
    using Scalar = Scalar_;
    static constexpr int Dim = Dim_;

    template <class Int>
    explicit System(const SpringArrays<Scalar, Dim, Int>& from);

    Index size() const { return static_cast<Index>(mass_.size()); }
    Index spring_count() const { return set_.size(); }
    bool is_pinned(Index i) const { return pinned_[std::size_t(i)]; }
    TangentReal<Scalar> mass(Index i) const { return mass_[std::size_t(i)]; }
    const RayleighDamping& rayleigh() const { return rayleigh_; }
    template <class Visitor>
    void for_each_set(Visitor&& visit) const {
        visit(set_);
    }
    /// Adds the dampers that no SpringSystem has, times `part`.
    Pencil complete(Pencil pencil, double part = 1) const {
        pencil.require_range("check_step");
        if (whole_.empty()) return pencil;
        std::vector<double> dampers = whole_;
        for (double& c : dampers) c *= part;
        pencil.add_dampers(dampers);
        return pencil;
    }

private:
    template <class Int>
    void add_particles(const SpringArrays<Scalar, Dim, Int>& from);
    template <class Int>
    void add_springs(const SpringArrays<Scalar, Dim, Int>& from);

    std::vector<TangentReal<Scalar>> mass_;  // kg; of pinned ones read by nobody
    std::vector<char> pinned_;
    SpringSet<Scalar, Hookean> set_;
    std::vector<double> whole_;  // dampers on the whole relative velocity; empty: none
    RayleighDamping rayleigh_;
};

template <class Scalar, int Dim>
template <class Int>
System<Scalar, Dim>::System(const SpringArrays<Scalar, Dim, Int>& from) : rayleigh_(from.rayleigh) {
    if (from.particles < 0 || from.springs < 0 || from.pins < 0) {
        fail("check_step: there are ", from.particles, " particles, ", from.springs,
             " springs and ", from.pins, " pins; none of these may be negative");
    }
    require_rows("mass", from.mass, from.particles, "particles");
    require_rows("inverse_mass", from.inverse_mass, from.particles, "particles");
    require_rows("position", from.position, from.particles, "particles");
    require_rows("pinned", from.pinned, from.pins, "pins");
    require_rows("ends", from.ends, from.springs, "springs");
    require_rows("stiffness", from.stiffness, from.springs, "springs");
    require_rows("rest_length", from.rest_length, from.springs, "springs");
    require_rows("damping", from.damping, from.springs, "springs");
    require_rows("whole_damping", from.whole_damping, from.springs, "springs");
    if (!from.ends && from.springs > 0) fail("check_step: ends is null, and there are springs");
    if (!from.pinned && from.pins > 0) fail("check_step: pinned is null, and there are pins");
    require_held<Scalar>("check_step", "mass_proportional", rayleigh_.mass_proportional);
    require_held<Scalar>("check_step", "stiffness_proportional", rayleigh_.stiffness_proportional);
    const Scalar f = from.velocity_factor;
    if (!(f >= 0 && f <= 1 && detail::is_finite(f)))
        fail("check_step: velocity_factor is ", f, "; it must be 0 ... 1");
    add_particles(from);
    add_springs(from);
    if (f == 1) return;
    // 4M − 2(1 − f)M − 2hD − h²K is that of masses times (1 + f)/2 [T44]. Drag acts on the masses
    // as they were.
    const TangentReal<Scalar> part = (1 + static_cast<TangentReal<Scalar>>(f)) / 2;
    for (auto& m : mass_) m *= part;
    rayleigh_.mass_proportional /= static_cast<double>(part);
}

template <class Scalar, int Dim>
template <class Int>
void System<Scalar, Dim>::add_particles(const SpringArrays<Scalar, Dim, Int>& from) {
    using Real = TangentReal<Scalar>;
    pinned_.resize(static_cast<std::size_t>(from.particles));
    for (Index p = 0; p < from.pins; ++p) {
        const auto i = static_cast<Index>(from.pinned(p));
        if (i < 0 || i >= from.particles) {
            fail("check_step: pin ", p, " holds particle ", i, "; there are ", from.particles,
                 ", numbered from 0");
        }
        pinned_[static_cast<std::size_t>(i)] = 1;
    }
    mass_.reserve(pinned_.size());
    for (Index i = 0; i < from.particles; ++i) {
        char& pinned = pinned_[static_cast<std::size_t>(i)];
        const bool inverse = static_cast<bool>(from.inverse_mass);
        const Scalar given = inverse ? from.inverse_mass(i) : from.mass(i);
        if (inverse && given == 0) pinned = 1;
        const bool inverted = inverse && given != 0;
        const Real mass = inverted ? 1 / static_cast<Real>(given) : static_cast<Real>(given);
        mass_.push_back(mass);
        if (pinned || (mass > 0 && detail::is_finite(mass))) continue;
        fail("check_step: the ", inverse ? "inverse mass" : "mass", " of particle ", i, " is ",
             given, "; it must be finite and > 0, or the particle pinned");
    }
}

template <class Scalar, int Dim>
template <class Int>
void System<Scalar, Dim>::add_springs(const SpringArrays<Scalar, Dim, Int>& from) {
    proof_detail::RangeCheck range;  // Pencil has its own for all else
    for (Index s = 0; s < from.springs; ++s) {
        const Index ends[] = {static_cast<Index>(from.ends(s, 0)),
                              static_cast<Index>(from.ends(s, 1))};
        for (const Index i : ends) {
            if (i >= 0 && i < from.particles) continue;
            fail("check_step: spring ", s, " joins particle ", i, "; there are ", from.particles,
                 ", numbered from 0");
        }
        if (ends[0] == ends[1]) {
            fail("check_step: both ends of spring ", s, " are particle ", ends[0],
                 "; a spring joins two different ones");
        }
        const Scalar whole = from.whole_damping(s);
        require_at_least_0("stiffness of spring", s, from.stiffness(s));
        require_at_least_0("rest length of spring", s, from.rest_length(s));
        require_at_least_0("damping of spring", s, from.damping(s));
        require_at_least_0("whole damping of spring", s, whole);
        set_.add({ends[0], ends[1], {from.stiffness(s)}, from.rest_length(s), from.damping(s)});
        if (whole > 0 && whole_.empty()) whole_.resize(static_cast<std::size_t>(from.springs));
        if (whole == 0) continue;
        whole_[static_cast<std::size_t>(s)] = range.in_range(whole, "whole damping of spring", s);
    }
    if (!range.lost().empty()) fail("check_step: ", range.lost());
}

/// A pencil as Stability takes a system.
template <class Scalar_>
struct Judged {
    using Scalar = Scalar_;
    std::shared_ptr<const Pencil> pencil;

    std::uint64_t revision() const { return 0; }
    friend std::shared_ptr<const Pencil> make_pencil(const Judged& judged) { return judged.pencil; }
};

template <class Scalar>
Stability<Scalar> stability_of(Pencil pencil) {
    return Stability<Scalar>(Judged<Scalar>{std::make_shared<const Pencil>(std::move(pencil))});
}

/// Whose the vibration is that sets the limit.
template <class Scalar>
std::vector<SpringShare> to_blame(const Stability<Scalar>& stability,
                                  const StepLimit<Scalar>& limit, Index count) {
    if (!(limit.certified > 0) || limit.unbounded() || count <= 0) return {};
    const Pencil& pencil = stability.pencil();
    std::vector<SpringShare> shares;
    if (limit.cause == Cause::damping && !pencil.is_rayleigh()) {
        using namespace matrices;
        const double h = static_cast<double>(limit.certified);
        const Combination force = 2 * h * D + h * h * K_plus;
        const RitzPair mode = proof_detail::largest_mode(pencil, force);
        shares = proof_detail::largest_shares(pencil.spring_shares(mode.vector, force), count);
    } else {
        shares = limiting_springs(stability, count);
    }
    while (!shares.empty() && !(shares.back().share > 0)) shares.pop_back();
    return shares;
}

template <class Scalar>
StepAnswer<Scalar> answer(const Stability<Scalar>& stability, const StepLimit<Scalar>& limit,
                          double h, const StepCheckOptions& options) {
    StepAnswer<Scalar> answer;
    answer.limit = limit;
    answer.safe = limit.substeps(h, options.safety) == 1;
    const double frame = options.frame == 0 ? h : options.frame;
    answer.substeps = limit.substeps(frame, options.safety).value_or(0);
    answer.to_blame = to_blame(stability, limit, options.to_blame);
    return answer;
}

/// The positions, Dim × n, m.
template <class Scalar, int Dim, class Int>
Points<TangentReal<Scalar>, Dim> pose(const SpringArrays<Scalar, Dim, Int>& arrays) {
    Points<TangentReal<Scalar>, Dim> x(Dim, arrays.particles);
    for (Index i = 0; i < arrays.particles; ++i) {
        for (int k = 0; k < Dim; ++k) {
            x(k, i) = arrays.position(i, k);
            if (detail::is_finite(x(k, i))) continue;
            fail("check_step: the position of particle ", i, " is not finite");
        }
    }
    return x;
}

}  // namespace arrays_detail

template <class Scalar, int Dim, class Int>
StepCheck<Scalar> check_step(const SpringArrays<Scalar, Dim, Int>& arrays, Method method, double h,
                             const StepCheckOptions& options) {
    using Damping = Pencil::Damping;
    require_positive("check_step", "h", h);
    require_non_negative("check_step", "frame", options.frame);
    if (!(options.safety > 0 && options.safety <= 1 && detail::is_finite(options.safety))) {
        fail("check_step: safety is ", options.safety, "; it must be > 0 and <= 1");
    }
    if (arrays.velocity_factor != 1 && method != Method::position_verlet) {
        fail("check_step: velocity_factor is for position_verlet, which is symplectic_euler; with ",
             name(method), " it must be 1");
    }
    const arrays_detail::System<Scalar, Dim> system(arrays);
    const auto laplacians = [&](Damping counted) {
        return system.complete(Pencil::any_pose(system, counted),
                               counted == Damping::half ? 0.5 : 1);
    };
    const auto moving = arrays_detail::stability_of<Scalar>(laplacians(Damping::all));
    const Damping counted = proof_detail::counted_at_any_pose(method);
    const auto limit = counted == Damping::all
                           ? proof_detail::at_any_pose(method, moving.pencil())
                           : proof_detail::at_any_pose(method, laplacians(counted));
    StepCheck<Scalar> check;
    static_cast<StepAnswer<Scalar>&>(check) =
        arrays_detail::answer(moving, proof_detail::rounded<Scalar>(limit, 0), h, options);
    if (arrays.position && method != Method::energy_stable_euler) {
        const auto here = arrays_detail::stability_of<Scalar>(
            system.complete(Pencil::at_pose(system, arrays_detail::pose(arrays))));
        check.at_pose = arrays_detail::answer(here, here.max_step(method), h, options);
    }
    return check;
}

}  // namespace taut
