// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#if __has_include(<Spectra/SymEigsShiftSolver.h>)

#include <algorithm>
#include <cmath>
#include <taut/lattice/chain.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/modal/modal_analysis.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/faults.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"
#if defined(TAUT_COMPILED)
#include "../../compiled/modal.hpp"
#endif

namespace taut_test::spectra_modal_analysis_test {

using taut::Index;
using taut::ModalBasis;

namespace {

/// A hanging strip of cloth, held along its upper edge, at its equilibrium.
taut::LinearSystem<double> hanging_strip() {
    taut::ClothOptions options;
    options.rows = 16;
    options.columns = 8;
    options.width = 0.5;
    options.pin_corners = false;
    auto cloth = taut::hanging_cloth<double>(options);
    for (Index c = 0; c < options.columns; ++c) cloth.pin(c);
    cloth.set_rayleigh({0.25, 1e-3});
    auto state = cloth.initial_state();
    state.x.row(2) = -state.x.row(1);  // hanging straight down
    state.x.row(1).setZero();
    REQUIRE(taut::static_equilibrium(cloth, state));
    return taut::linearize(cloth, state);
}

/// Orthonormal in M, eigenvectors of K, with the damping and the load that go with them.
void check_basis(const taut::LinearSystem<double>& system, const ModalBasis& basis, double k_max) {
    const Index r = basis.size();
    const Eigen::MatrixXd M = system.mass().asDiagonal();
    const Eigen::MatrixXd unit = basis.shapes.transpose() * M * basis.shapes;
    CHECK(distance(unit, Eigen::MatrixXd::Identity(r, r)) <= Tolerance<double>::accumulated);
    const Eigen::MatrixXd left =
        system.stiffness() * basis.shapes - M * basis.shapes * basis.k.asDiagonal();
    const Eigen::MatrixXd scaled = system.mass().cwiseSqrt().cwiseInverse().asDiagonal() * left;
    CHECK(largest(scaled) <= Tolerance<double>::accumulated * k_max);
    const Eigen::MatrixXd D = basis.shapes.transpose() * system.damping() * basis.shapes;
    CHECK(distance(D.diagonal(), basis.d) <= Tolerance<double>::accumulated * largest(D));
    CHECK(distance(basis.shapes.transpose() * system.load(), basis.p) <=
          Tolerance<double>::accumulated);
}

}  // namespace

TEST_CASE("modal_analysis: the lowest modes of a cloth at its equilibrium are the dense solver's",
          "[modal]") {
    const auto system = hanging_strip();
    const Eigen::MatrixXd K(system.stiffness());
    const Eigen::MatrixXd M = system.mass().asDiagonal();
    const Eigen::VectorXd k = generalized_modes(K, M).values;
    const double k_max = k[k.size() - 1];
    for (const Index r : {Index(1), Index(20), Index(150)}) {  // the last one densely
        ModalBasis basis;
        taut::Report report;
        CHECK(faults_of([&] { report = taut::modal_analysis(system, r, basis); }) == 0);
        REQUIRE(report);
        CHECK(report.residual <= Tolerance<double>::accumulated);
        REQUIRE(basis.size() == r);
        CHECK(distance(basis.k, k.head(r)) <= Tolerance<double>::rounding * k_max);
        CHECK(basis.rigid() == 0);
        check_basis(system, basis, k_max);
        for (Index i = 0; i < r; ++i) {  // Rayleigh: d = d0 + αk, but for compressed springs
            CHECK(basis.d[i] >= 0.25 + 1e-3 * basis.k[i] - Tolerance<double>::accumulated);
        }
    }
}

TEST_CASE("modal_analysis: a long chain has its closed form, and a free one its rigid motion",
          "[modal]") {
    const Index n = 400;
    for (const auto ends : {taut::ChainEnds::fixed_fixed, taut::ChainEnds::free_free}) {
        const auto chain = taut::chain<double, 1>({n, ends, 0.5, 200});
        const auto system = taut::linearize(chain, chain.initial_state());
        ModalBasis basis;
        REQUIRE(taut::modal_analysis(system, 10, basis));
        const bool free = ends == taut::ChainEnds::free_free;
        CHECK(basis.rigid() == (free ? 1 : 0));
        for (Index j = 0; j < 10; ++j) {
            const double angle = static_cast<double>(EIGEN_PI) / 2 *
                                 static_cast<double>(free ? j : j + 1) /
                                 static_cast<double>(free ? n : n + 1);
            const double k = 1600 * std::pow(std::sin(angle), 2);
            CHECK_THAT(basis.k[j], WithinAbs(k, Tolerance<double>::rounding * 1600));
        }
        check_basis(system, basis, 1600);
    }
}

TEST_CASE("modal_analysis: every mechanism of a flat net counts as rigid", "[modal]") {
    // Without bending and shear the flat net has no stiffness across its plane: 100 modes, and more
    // in it.
    taut::ClothOptions options;
    options.rows = options.columns = 10;
    options.pin_corners = false;
    const auto cloth = taut::hanging_cloth<double>(options);
    const auto system = taut::linearize(cloth, cloth.initial_state());
    ModalBasis basis;
    REQUIRE(taut::modal_analysis(system, 120, basis));
    CHECK(basis.rigid() == 103);
}

TEST_CASE("modal_analysis: sixfold eigenvalues of a symmetric net are found six times", "[modal]") {
    // A square net of springs without length splits into rows and coordinates: its eigenvalues are
    // sums of two of a row's, each three times, and twice that where the two differ.
    const Index side = 14;
    taut::SpringSystem<double, 3> net;
    for (Index i = 0; i < (side + 2) * (side + 2); ++i) {
        const Index row = i / (side + 2);
        const Index column = i % (side + 2);
        net.add_particle({static_cast<double>(row), static_cast<double>(column), 0}, 0.5);
        if (row % (side + 1) == 0 || column % (side + 1) == 0) net.pin(i);
    }
    for (Index i = 0; i < net.size(); ++i) {
        for (const Index step : {Index(1), side + 2}) {
            const bool last = step == 1 ? i % (side + 2) == side + 1 : i + step >= net.size();
            if (!last) net.add_spring(taut::Spring<double, taut::Hookean>{i, i + step, {200}, 0});
        }
    }
    std::vector<double> expected;
    const auto of_row = [](Index j) {
        const double angle =
            static_cast<double>(EIGEN_PI) / 2 * static_cast<double>(j) / (side + 1);
        return 1600 * std::pow(std::sin(angle), 2);
    };
    for (Index i = 1; i <= side; ++i) {
        for (Index j = 1; j <= side; ++j) expected.insert(expected.end(), 3, of_row(i) + of_row(j));
    }
    std::sort(expected.begin(), expected.end());
    const auto system = taut::linearize(net, net.initial_state());
    REQUIRE(system.size() == 3 * side * side);
    for (const Index count : {Index(4), Index(30), Index(100)}) {
        INFO("count " << count);
        ModalBasis basis;
        REQUIRE(taut::modal_analysis(system, count, basis));
        for (Index j = 0; j < count; ++j) {
            CHECK_THAT(basis.k[j], WithinRel(expected[static_cast<std::size_t>(j)], 1e-9));
        }
        check_basis(system, basis, 3200);
    }
}

TEST_CASE("modal_analysis: a count out of range is refused by name", "[modal][bad_input]") {
    const auto chain = taut::chain<double, 1>({5});
    const auto system = taut::linearize(chain, chain.initial_state());
    ModalBasis basis;
    for (const Index count : {Index(0), Index(6), Index(-1)}) {
        CHECK(missing(message_of([&] { (void)taut::modal_analysis(system, count, basis).status; }),
                      {"modal_analysis", "count is ", "5"}) == "");
    }
    CHECK(basis.size() == 0);
}

}  // namespace taut_test::spectra_modal_analysis_test

#endif
