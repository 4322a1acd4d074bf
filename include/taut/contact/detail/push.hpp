// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "body.hpp"

namespace taut::contact_detail {

/// Contact of a body's touching pairs, a register of them at a time: fills end, speed, pushed and
/// work from what was at the start and would be without.
/// @param carry  carry(at, x, n) makes of x and n of a register of near pairs g(x) and n′
template <class Scalar, int Dim, class Carry>
void push(Body<Scalar, Dim>& body, const Carry& carry, const Penalty<Scalar>& penalty) {
    using Register = step_detail::VectorRegister<Scalar>;
    using Vectors = detail::Few<Register, Dim>;
    Touching<Scalar, Dim>& touching = body.touching;
    NearPairs<Scalar, Dim>& pairs = body.near_pairs;
    const Register zero(Scalar(0)), one(Scalar(1)), h(penalty.h);
    const Register infinity(std::numeric_limits<Scalar>::infinity());
    const Register by_block(1 / (1 + penalty.block()));
    const Register most(static_cast<Scalar>(body.options.push_out));
    const Register friction(static_cast<Scalar>(body.options.friction));
    for (Index t = 0; t < touching.count; ++t) {
        const Index k = t * Register::width, at = touching.first[t];
        Vectors x, v, from, n, u, w;
        for (int d = 0; d < Dim; ++d) {
            x[d] = touching.x().row(d, k);
            v[d] = touching.v().row(d, k);
            from[d] = pairs.now.x().row(d, at);
            n[d] = pairs.now.normal().row(d, at);
        }
        Vectors carried = from;
        carry(at, carried, n);
        for (int d = 0; d < Dim; ++d) {
            u[d] = (carried[d] - from[d]) * Register(1 / penalty.h);
            w[d] = v[d] - u[d];
        }
        const Register before = Register::load(pairs.now.depth() + at);
        const Register depth = Register::load(pairs.next.depth() + at);
        const Register cap = Register::load(pairs.now.cap() + at);
        const Register deep = larger(before, zero);
        const Register force = Register(penalty.by_mass) * where_less(deep, cap, deep, cap);
        const Register into = dot(w, n);
        Register out = rest(into * by_block, h * force * by_block);
        // What began inside leaves no faster than is asked, and comes to rest at the surface: less
        // of φ′ will do where it goes out.
        Register asked = deep * Register(1 / (2 * penalty.h));
        asked = where_less(asked, most, asked, most);
        const Register slow = larger(where_less(out, asked, out, asked), into * by_block);
        out = where_less(cap, infinity, slow, out);
        const Register impulse = out - into;  // hλ/m
        // A pair that would pull is left out if it goes no deeper so; what began inside is braked.
        const Register pulls =
            where_less(cap, infinity, zero, where_less(impulse, zero, deep, zero));
        Register pushed = Register::load(touching.pushed() + k);
        pushed = where_less(zero, pulls, where_less(before, depth, pushed, zero), pushed);
        pushed.store(touching.pushed() + k);
        Vectors along;
        for (int d = 0; d < Dim; ++d) along[d] = w[d] - into * n[d];
        const Register by_sliding = reciprocal_sqrt(
            larger(dot(along, along), Register((std::numeric_limits<Scalar>::min)())));
        // And slips out.
        const Register rubs = where_less(cap, infinity, zero, friction);
        const Register keep = larger(zero, one - rubs * larger(impulse, zero) * by_sliding);
        Register work = zero;
        for (int d = 0; d < Dim; ++d) {
            const Register after = u[d] + out * n[d] + keep * along[d];
            work += u[d] * (after - v[d]);
            x[d] = where_less(zero, pushed, from[d] + h * after, x[d]);
            v[d] = where_less(zero, pushed, after, v[d]);
            x[d].store(&touching.end()(d, k));
            v[d].store(&touching.speed()(d, k));
        }
        (work * Register::load(pairs.mass.data() + at)).store(touching.work() + k);
    }
}

}  // namespace taut::contact_detail
