// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What an engine would write: its own log in place of assert, and its own way out.
void engine_assert(bool holds, const char* sentence);
[[noreturn]] void engine_fail(const char* message);

#define TAUT_ASSERT(condition, sentence) engine_assert((condition), (sentence))
#define TAUT_FAIL(message) engine_fail(message)
