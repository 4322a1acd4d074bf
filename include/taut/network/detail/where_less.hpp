// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut::network_detail {

/// `yes` where a < b, `no` elsewhere; registers have their own, lane by lane.
template <class Real>
Real where_less(const Real& a, const Real& b, const Real& yes, const Real& no) {
    return a < b ? yes : no;
}

}  // namespace taut::network_detail
