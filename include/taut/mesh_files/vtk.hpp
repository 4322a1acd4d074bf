// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../core/detail/fits.hpp"
#include "../core/error.hpp"
#include "../network/spring_system.hpp"
#include "detail/number_text.hpp"
#include "detail/output_file.hpp"

namespace taut {
namespace io_detail {

/// visit(law, a, b, rest length, length, tension) for every spring at x, in index order.
template <class System, class Visitor>
void for_each_tension(const System& system, const typename System::Force& x, Visitor&& visit) {
    using Scalar = typename System::Scalar;
    int law = 0;
    system.for_each_set([&](const auto& set) {
        for (const auto spring : set) {
            const Scalar l = (x.col(spring.b) - x.col(spring.a)).norm();
            // Where the ends meet there is no direction, and so no force.
            visit(law, spring, l, l > 0 ? spring.tension(l) : Scalar(0));
        }
        ++law;
    });
}

/// One number a spring, as cell data.
template <class System, class Value>
void write_spring_data(std::FILE* file, const char* name, const System& system,
                       const typename System::Force& x, Value&& value) {
    std::fprintf(file, "SCALARS %s double 1\nLOOKUP_TABLE default\n", name);
    for_each_tension(system, x, [&](int law, const auto& spring, auto l, auto T) {
        put_number(file, static_cast<double>(value(law, spring.rest_length, l, T)), '\n');
    });
}

/// Three numbers a particle; missing dimensions are 0.
template <class Scalar, int Dim>
void write_triples(std::FILE* file, const Points<Scalar, Dim>& values) {
    for (Index i = 0; i < values.cols(); ++i) put_column(file, values, i);
}

}  // namespace io_detail

/// Writes a state as a legacy VTK file (ASCII, POLYDATA, read by ParaView): a point a particle with
/// velocity (m/s), mass (kg) and pinned (0, 1), a line a spring with
///
///     tension  T(l), N, of the spring alone: negative pushes, dampers are left out
///     strain   l/L − 1; 0 for a spring without rest length
///     law      its place among the system's laws, from 0.
/// Files named cloth_0.vtk, cloth_1.vtk … are one animation to ParaView.
template <class System>
FileReport write_vtk(const std::string& path, const System& system,
                     const typename System::State& state) {
    detail::require_fits("write_vtk", state, system.size());
    if (const Index i = io_detail::first_unwritable<double>(state.x); i >= 0) {
        return {FileStatus::not_finite, path, i};
    }
    if (const Index i = io_detail::first_unwritable<double>(state.v); i >= 0) {
        return {FileStatus::not_finite, path, i};
    }
    io_detail::OutputFile out(path);
    if (!out.is_open()) return out.report();
    std::FILE* file = out.get();
    const auto particles = static_cast<long long>(system.size());
    const auto springs = static_cast<long long>(system.spring_count());
    std::fputs("# vtk DataFile Version 3.0\nTaut, t in s: ", file);
    io_detail::put_number(file, static_cast<double>(state.time), '\n');
    std::fprintf(file, "ASCII\nDATASET POLYDATA\nPOINTS %lld double\n", particles);
    io_detail::write_triples(file, state.x);
    std::fprintf(file, "LINES %lld %lld\n", springs, 3 * springs);
    system.for_each_spring([&](Index a, Index b) {
        std::fprintf(file, "2 %lld %lld\n", static_cast<long long>(a), static_cast<long long>(b));
    });
    std::fprintf(file, "CELL_DATA %lld\n", springs);
    io_detail::write_spring_data(file, "tension", system, state.x,
                                 [](int, auto, auto, auto T) { return T; });
    io_detail::write_spring_data(file, "strain", system, state.x, [](int, auto L, auto l, auto) {
        return L > 0 ? l / L - 1 : decltype(L)(0);
    });
    io_detail::write_spring_data(file, "law", system, state.x,
                                 [](int law, auto, auto, auto) { return law; });
    std::fprintf(file, "POINT_DATA %lld\nVECTORS velocity double\n", particles);
    io_detail::write_triples(file, state.v);
    std::fprintf(file, "SCALARS mass double 1\nLOOKUP_TABLE default\n");
    for (Index i = 0; i < system.size(); ++i) {
        io_detail::put_number(file, static_cast<double>(system.mass(i)), '\n');
    }
    std::fprintf(file, "SCALARS pinned int 1\nLOOKUP_TABLE default\n");
    for (Index i = 0; i < system.size(); ++i) std::fputs(system.is_pinned(i) ? "1\n" : "0\n", file);
    return out.close();
}

}  // namespace taut
