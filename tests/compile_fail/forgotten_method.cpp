// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: a method has no descriptor in the list

#include <taut/conditions/visit.hpp>

namespace method = taut::method;
using Forgetful = method::List<method::ExplicitEuler, method::SymplecticEuler,
                               method::VelocityVerlet, method::ImplicitEuler>;
static_assert(method::require_every_method(Forgetful{}));
