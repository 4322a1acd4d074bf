// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion.hpp"

namespace taut::contact_detail {

/// What is known of pairs where a step begins or ends: rows side by side, one for each number.
template <class Scalar, int Dim>
struct PairTable {
    using Access = PlaneAccess<Scalar, Dim>;

    Index stride = 0;
    Buffer<Scalar> numbers;

    void resize(Index size) {
        stride = size;
        numbers.resize((2 * Dim + 2) * size);
    }
    Access x() { return Access(numbers.data(), stride); }  // of the particle, m
    Access normal() { return Access(numbers.data() + Dim * stride, stride); }
    Scalar* depth() { return numbers.data() + 2 * Dim * stride; }      // p, m
    Scalar* cap() { return numbers.data() + (2 * Dim + 1) * stride; }  // p₁, m
};

/// The particles near a body, at the start of a step and at its end, in whole registers. What
/// fills the last one has no mass.
template <class Scalar, int Dim>
struct NearPairs {
    using Register = step_detail::VectorRegister<Scalar>;

    Index count = 0, size = 0;
    Buffer<int> place;
    Buffer<int> several;  // index of the particle among those near several bodies, or −1
    Buffer<int> mixed;    // of each register, whether it has such a one
    Buffer<Scalar> mass;  // kg
    PairTable<Scalar, Dim> now, next;
    Buffer<int> again;  // pairs whose particle another body has pushed in this step

    void begin(Index pairs) {
        count = pairs;
        size = whole_registers<Scalar>(pairs);
        place.assign(size, 0);
        several.assign(size, -1);
        mixed.assign(size / Register::width, 0);
        mass.assign(size, Scalar(0));
        now.resize(size);
        next.resize(size);
    }
};

/// The registers of near pairs that touch in a step: rows side by side, one for each number.
template <class Scalar, int Dim>
struct Touching {
    using Access = PlaneAccess<Scalar, Dim>;

    Index count = 0, stride = 0;
    Buffer<int> first;       // pair of each
    Index pushed_count = 0;  // of pairs
    Buffer<int> row, place;  // of a pushed one: in the rows here, particle
    Buffer<Scalar> numbers;

    void begin(Index size) {
        count = 0;
        stride = size;
        pushed_count = 0;
        for (auto* of : {&first, &row, &place}) of->resize(size);
        numbers.resize((5 * Dim + 3) * size);
    }
    Access x() { return vectors(0); }        // without contact, m
    Access v() { return vectors(1); }        // without contact, m/s
    Access end() { return vectors(2); }      // x with contact
    Access speed() { return vectors(3); }    // v with contact
    Access normal() { return vectors(4); }   // at the end
    Scalar* depth() { return scalars(0); }   // at the end, m
    Scalar* pushed() { return scalars(1); }  // > 0 where it touches, then where it is pushed
    Scalar* work() { return scalars(2); }    // h ū·f, J
    /// Of a row, among near pairs.
    Index pair(Index of) const {
        constexpr int width = step_detail::VectorRegister<Scalar>::width;
        return first[of / width] + of % width;
    }

    /// Lists what is pushed. @param places  of near pairs
    void list_pushed(const Buffer<int>& places) {
        constexpr int width = step_detail::VectorRegister<Scalar>::width;
        const Scalar* on = pushed();
        int *to_row = row.data(), *to_place = place.data();
        Index n = 0;
        for (Index t = 0; t < count; ++t) {
            const int* from = places.data() + first[t];
            for (int lane = 0; lane < width; ++lane) {
                to_row[n] = static_cast<int>(t * width) + lane;
                to_place[n] = from[lane];
                n += on[t * width + lane] > 0;
            }
        }
        pushed_count = n;
    }
    /// visit(j, its row) for what is listed and still pushed.
    template <class Visitor>
    void each_pushed(Visitor&& visit) {
        for (Index j = 0; j < pushed_count; ++j) {
            if (pushed()[row[j]] > 0) visit(j, Index(row[j]));
        }
    }

private:
    Access vectors(Index i) { return Access(numbers.data() + i * Dim * stride, stride); }
    Scalar* scalars(Index i) { return numbers.data() + (5 * Dim + i) * stride; }
};

/// The planes that contact reads and writes.
template <class Scalar, int Dim>
struct Moving {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    PlaneAccess<Scalar, Dim> x, v, spring_x;
    Scalar ahead;  // s, by which springs see x ahead

    void set(Index place, const Vector& to, const Vector& speed) const {
        x.set(place, to);
        v.set(place, speed);
        if (ahead > 0) spring_x.set(place, to + ahead * speed);
    }
    /// The same of all that a body has pushed.
    void scatter(Touching<Scalar, Dim>& of) const {
        const int *places = of.place.data(), *rows = of.row.data();
        for (Index j = 0; j < of.pushed_count; ++j)
            set(places[j], of.end().vector(rows[j]), of.speed().vector(rows[j]));
    }
};

}  // namespace taut::contact_detail
