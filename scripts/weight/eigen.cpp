// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What the other units are beside.

#include <Eigen/Dense>
#include <Eigen/Sparse>
