// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../conditions/visit.hpp"
#include "explicit_limit.hpp"
#include "symplectic_limit.hpp"

namespace taut::proof_detail {

/// What bounds alone certify, by what limits a method. Of springs K⁺ ⪰ 0, which is enough for every
/// step of implicit Euler to be solvable and stable [T20], [T27].
struct ByBounds {
    const Pencil& pencil;

    UnroundedLimit operator()(method::LimitedByDamping) const {
        return explicit_by_bounds(pencil, pencil.upper_bound(K_plus), pencil.upper_bound(D));
    }
    UnroundedLimit operator()(method::LimitedByStiffness) const {
        return symplectic_by_bounds(pencil);
    }
    UnroundedLimit operator()(method::LimitedByIndefiniteness) const {
        return {infinity, infinity, Cause::unconditional};
    }
    void add_growth(UnroundedLimit& limit) const { add_compression(pencil, limit); }
};

/// The limit of a method. @param by  by(what limits it), and by.add_growth(limit), of springs
template <class Scalar, class By>
StepLimit<Scalar> limit_of(Method method, const Pencil& pencil, std::uint64_t revision,
                           const By& by) {
    UnroundedLimit limit{infinity, infinity, Cause::nothing_to_limit};
    if (pencil.size() > 0) {
        limit = method::visit_limited("Stability", method, [&](auto descriptor) {
            return by(typename decltype(descriptor)::Limit{});
        });
        forget_unheld<Scalar>(limit);
        const BareMatrices* matrices = pencil.matrices();
        matrices ? matrices->amend(method, pencil, limit) : by.add_growth(limit);
    }
    return rounded<Scalar>(limit, revision);
}

}  // namespace taut::proof_detail
