// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "../examples/common/mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/scene/mesh.hpp>

#include "../tests/support/temporary_file.hpp"

/// A mesh is read or refused, and so are its springs. One short line says what was skipped.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const taut_test::TemporaryFile file("input");  // readers take one
    file.write(data, size);
    try {
        std::ostringstream warnings;
        const auto mesh = example::read_obj(file.path, warnings);
        const std::string said = warnings.str();
        const auto ends = std::count_if(said.begin(), said.end(),
                                        [](unsigned char c) { return std::iscntrl(c) != 0; });
        if (said.empty() != mesh.skipped.empty() || ends > 1 || said.size() > 600) std::abort();
        (void)taut::springs_from_mesh<double>(mesh.vertices, mesh.faces);
    } catch (const std::runtime_error&) {     // the reader's
    } catch (const std::invalid_argument&) {  // the library's
    }
    return 0;
}
