// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "obj_text.hpp"

namespace example {

/// Reads an OBJ file. Throws std::runtime_error naming the file and the line.
/// @param warnings  gets a line if statements were skipped
inline MeshFile read_obj(const std::string& path, std::ostream& warnings = std::cerr) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    std::ostringstream bytes;
    bytes << file.rdbuf();  // nothing, from a folder
    ObjText text = parse_obj(bytes.str());
    if (!text.why.empty()) {
        const std::string line = text.line > 0 ? ":" + std::to_string(text.line) : "";
        throw std::runtime_error(path + line + ": " + text.why);
    }
    if (!text.mesh.skipped.empty()) warnings << path << ": " << text.mesh.skipped << '\n';
    return std::move(text.mesh);
}

}  // namespace example
