// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// An engine replaces TAUT_ASSERT, TAUT_FAIL or both: define TAUT_USER_CONFIG as the name of a
/// header that defines them, for the whole build (one definition rule), never in a single source
/// file.
#ifdef TAUT_USER_CONFIG
#include TAUT_USER_CONFIG
#endif

/// Checks an invariant of Taut itself, in debug builds. Never used on a user's input.
#ifndef TAUT_ASSERT
#include <cassert>
#define TAUT_ASSERT(condition, sentence) assert((condition) && (sentence))
#endif

/// Receives a complete message about wrong input (const char*). Must not return.
/// Default: throws std::invalid_argument; with exceptions off, writes to stderr and aborts.
#ifndef TAUT_FAIL
#if defined(__cpp_exceptions) || defined(__EXCEPTIONS) || defined(_CPPUNWIND)
#include <stdexcept>
#define TAUT_FAIL(message) throw std::invalid_argument(message)
#else
#include <cstdio>
#include <cstdlib>
#define TAUT_FAIL(message) (std::fputs(message, stderr), std::fputc('\n', stderr), std::abort())
#endif
#endif

/// Of what is called once in a while: compiled small, and fast.
#if defined(__GNUC__)
#define TAUT_COLD __attribute__((cold))
#else
#define TAUT_COLD
#endif

/// Of what is not compiled into its callers.
#if defined(__GNUC__)
#define TAUT_NOINLINE __attribute__((noinline))
#else
#define TAUT_NOINLINE
#endif

/// Of what Taut::Compiled may do otherwise on this processor: compiled/by_kernel.hpp.
#ifndef TAUT_BY_KERNEL
#define TAUT_BY_KERNEL(find, ...) static_cast<void>(0)
#endif

/// Of what a header declares and its -inl.hpp defines: compiled with the program, or once in
/// Taut::Compiled, whose users do not see it.
#if defined(TAUT_COMPILED)
#define TAUT_INLINE
#else
#define TAUT_INLINE inline
#endif
