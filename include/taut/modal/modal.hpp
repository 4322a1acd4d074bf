// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module own_matrices.

// A few lowest modes and their motion. Needs Spectra: link Taut::Modal.

#include "modal_analysis.hpp"
#include "modal_dynamics.hpp"
