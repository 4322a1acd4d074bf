// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace example {

/// What `body` returns; `file` goes in front of its complaint.
template <class Body>
auto naming(const std::string& file, Body&& body) {
    try {
        return body();
    } catch (const std::exception& error) {
        throw std::runtime_error(file + ": " + error.what());
    }
}

}  // namespace example
