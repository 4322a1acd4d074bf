// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "../examples/common/matrix_market.hpp"

#include <cstdint>
#include <stdexcept>
#include <taut/own_matrices/linear_system.hpp>

#include "../tests/support/temporary_file.hpp"

/// A matrix is read or refused, and so is the system that it is the masses and the stiffness of.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const taut_test::TemporaryFile file("input");  // readers take one
    file.write(data, size);
    try {
        const auto K = example::read_matrix_market(file.path).mass_matrix();
        (void)taut::LinearSystem<double>(Eigen::VectorXd::Ones(K.rows()), {}, K);
        (void)taut::LinearSystem<double>(taut::diagonal_mass(K), {}, K);
    } catch (const std::runtime_error&) {     // the reader's
    } catch (const std::invalid_argument&) {  // the library's
    }
    return 0;
}
