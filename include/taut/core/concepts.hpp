// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

#include "status.hpp"
#include "types.hpp"

namespace taut {
namespace detail {

template <class Void, template <class...> class Operation, class... Args>
struct detector : std::false_type {};
template <template <class...> class Operation, class... Args>
struct detector<std::void_t<Operation<Args...>>, Operation, Args...> : std::true_type {};
template <template <class...> class Operation, class... Args>
inline constexpr bool is_detected_v = detector<void, Operation, Args...>::value;

template <class T>
using scalar_of = typename T::Scalar;
template <class T>
using state_of = typename T::State;
template <class T>
using force_of = decltype(std::declval<const T&>().force(std::declval<const typename T::State&>(),
                                                         std::declval<decltype(T::State::x)&>()));
template <class T>
using size_of = decltype(std::declval<const T&>().size());
template <class T>
using inverse_mass_of = decltype(std::declval<const T&>().inverse_mass());
template <class T>
using revision_of = decltype(std::declval<const T&>().revision());
template <class T>
using force_revision_of = decltype(std::declval<const T&>().force_revision());

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

/// The System concept (docs/concepts.md): one readable sentence for each missing member.
template <class T>
constexpr void require_system() {
    static_assert(detail::is_detected_v<detail::scalar_of, T>,
                  "taut::System: needs the type `Scalar`");
    static_assert(detail::is_detected_v<detail::state_of, T>,
                  "taut::System: needs the type `State`, with x, v and time");
    static_assert(detail::is_detected_v<detail::size_of, T>,
                  "taut::System: needs `Index size() const`, the number of particles");
    static_assert(detail::is_detected_v<detail::force_of, T>,
                  "taut::System: needs `void force(const State&, Points& f) const`");
    static_assert(
        detail::is_detected_v<detail::inverse_mass_of, T>,
        "taut::System: needs `inverse_mass() const`, 1/kg for each particle, 0 if pinned");
    static_assert(detail::is_detected_v<detail::revision_of, T>,
                  "taut::System: needs `revision() const`, a number that changes with the system");
    static_assert(
        detail::is_detected_v<detail::force_revision_of, T>,
        "taut::System: needs `force_revision() const`, a number that changes with the force");
}

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
