// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

#include "../../core/types.hpp"

namespace taut::proof_detail {

/// Takes the numbers of a system to double, and names the first one that is out of the range of the
/// analysis.
class RangeCheck {
public:
    /// The value of a mass, a stiffness or a damping: 0, or of a size whose square keeps its
    /// digits. @param what  what it is of particle, spring or row `index`
    template <class Real>
    double in_range(Real value, const char* what, Index index) {
        return within(value, what, index, 1 / square_holds, square_holds);
    }
    /// Notes a length, m, whose square overflows.
    template <class Real>
    void check_length(Real value, const char* what, Index index) {
        within(value, what, index, 0, square_holds);
    }
    /// Its name and value; empty where there is none.
    const std::string& lost() const { return lost_; }

private:
    static constexpr double square_holds = 0x1p500;

    template <class Real>
    double within(Real value, const char* what, Index index, double least, double most) {
        const auto size = static_cast<std::common_type_t<Real, double>>((std::abs)(value));
        if (lost_.empty() && size != 0 && !(size >= least && size <= most)) {
            lose(static_cast<long double>(value), what, index, least, most);
        }
        return static_cast<double>(value);
    }
    void lose(long double value, const char* what, Index index, double least, double most) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "the %s %lld is %.9Lg; the analysis is in double and takes 0 and sizes "
                      "from %.3g to %.3g",
                      what, static_cast<long long>(index), value, least, most);
        lost_ = text;
    }

    std::string lost_;
};

}  // namespace taut::proof_detail
