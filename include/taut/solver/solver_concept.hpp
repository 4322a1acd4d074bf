// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../core/concepts.hpp"

namespace taut {
namespace detail {

template <class Solver, class Matrix>
using analyze_pattern_of =
    decltype(std::declval<Solver&>().analyzePattern(std::declval<const Matrix&>()));
template <class Solver, class Matrix>
using factorize_of = decltype(std::declval<Solver&>().factorize(std::declval<const Matrix&>()));
template <class Solver, class Vector>
using solve_of = decltype(std::declval<const Solver&>().solve(std::declval<const Vector&>()));
template <class Solver>
using up_lo_of = decltype(Solver::UpLo);

}  // namespace detail

/// The Solver concept: Eigen's own sparse solver interface, so that every Eigen solver fits.
template <class Solver, class Scalar>
constexpr void require_solver() {
    static_assert(detail::is_detected_v<detail::analyze_pattern_of, Solver, SparseMatrix<Scalar>>,
                  "taut::Solver: needs `analyzePattern(const SparseMatrix&)`");
    static_assert(detail::is_detected_v<detail::factorize_of, Solver, SparseMatrix<Scalar>>,
                  "taut::Solver: needs `factorize(const SparseMatrix&)`");
    static_assert(detail::is_detected_v<detail::solve_of, Solver, VectorX<Scalar>>,
                  "taut::Solver: needs `solve(const VectorX&) const`");
}

/// Whether a solver reads one triangle only, as Eigen's symmetric solvers declare by `UpLo`.
template <class Solver>
inline constexpr bool is_symmetric_solver_v = detail::is_detected_v<detail::up_lo_of, Solver>;

}  // namespace taut
