// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "steps.hpp"

void bench::plain_steps(PlainLoop<double>& loop, double h, int count) {
    for (int i = 0; i < count; ++i) loop.step(h);
}
