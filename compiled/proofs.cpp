// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "by_kernel.hpp"
#include <taut/proof/detail/symplectic_limit-inl.hpp>
#include <taut/proof/pencil-inl.hpp>
#include <taut/proof/pencil_matrix-inl.hpp>
#include <taut/proof/rayleigh-inl.hpp>
#include <taut/proof/stability-inl.hpp>

#include "kernels.hpp"

#if defined(__FAST_MATH__) || defined(_M_FP_FAST)
#error "Taut::Compiled is compiled strictly: the flag was lost"
#endif

namespace taut {

template SparseMatrix<double> Pencil::assemble<double>(const Combination&) const;
template SparseMatrix<double> Pencil::assemble_least<double>(const Combination&) const;
template double Pencil::assembly_error<double>(const Combination&, const Eigen::VectorXd&) const;
template std::vector<double> Pencil::particle_loads(const Combination&,
                                                    const std::vector<double>&) const;
template Pencil Pencil::scaled<double>(double, double) const;
template void Pencil::add_dampers(const std::vector<double>&);
template Pencil Pencil::explicit_part(const std::vector<double>&) const;

template class Stability<float>;
template class Stability<double>;

}  // namespace taut
