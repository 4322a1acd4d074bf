// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>

namespace taut_test {

/// The text of the std::invalid_argument that `action` throws; empty if it throws nothing.
template <class Action>
std::string message_of(Action&& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

/// Empty if the message contains every one of the words, else what is missing from what.
inline std::string missing(const std::string& message, std::initializer_list<const char*> words) {
    for (const char* word : words) {
        if (message.find(word) == std::string::npos) {
            return "no \"" + std::string(word) +
                   "\" in: " + (message.empty() ? "(no error)" : message);
        }
    }
    return {};
}

}  // namespace taut_test
