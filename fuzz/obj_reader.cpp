// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "../examples/common/mesh_file.hpp"

#include <cstdint>
#include <stdexcept>
#include <taut/scene/mesh.hpp>

#include "../tests/support/temporary_file.hpp"

/// A mesh is read or refused, and so are its springs.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const taut_test::TemporaryFile file("input");  // readers take one
    file.write(data, size);
    try {
        const auto mesh = example::read_obj(file.path);
        (void)taut::springs_from_mesh<double>(mesh.vertices, mesh.faces);
    } catch (const std::runtime_error&) {     // the reader's
    } catch (const std::invalid_argument&) {  // the library's
    }
    return 0;
}
