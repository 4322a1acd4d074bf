// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/bdf2/bdf2.hpp>
#include <taut/constraints/constraints.hpp>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/conditions/visit.hpp>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/projective/projective.hpp>
#include <taut/resolution/coarsen.hpp>
#include <taut/taut.hpp>
