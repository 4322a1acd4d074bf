// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: a descriptor lacks a member

#include <taut/conditions/visit.hpp>

namespace method = taut::method;

struct Unlimited : method::Bdf2 {
private:
    using method::Bdf2::critical_step;
};
using Listed = method::List<method::ExplicitEuler, method::SymplecticEuler, method::VelocityVerlet,
                            method::ImplicitEuler, Unlimited>;
static_assert(method::require_every_method(Listed{}));
