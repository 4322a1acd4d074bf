// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>

namespace taut::detail {

/// The border between a point that passes a test and one that fails it, both ≥ 0, in either order.
///
///     Bisection<double> search(passes, fails, 1e-9);
///     while (search.open()) search.narrow(test(search.middle()));
///     use(search.passes());
///
/// It ends for every pair of points, NaN and infinity too: when the points are neighbours, at most.
template <class Real>
class Bisection {
public:
    /// Enough to part any two numbers of 64 bits, whatever their exponents.
    static constexpr int most_halvings = 128;

    /// @param tolerance  relative distance of the two points that is close enough
    Bisection(Real passes, Real fails, Real tolerance, int halvings = most_halvings)
        : passes_(passes), fails_(fails), tolerance_(tolerance), halvings_(halvings) {}

    /// Whether there is a point left to test.
    bool open() const {
        const auto [low, high] = std::minmax(passes_, fails_);
        const Real between = middle();
        return halvings_ > 0 && high - low > tolerance_ * low && low < between && between < high;
    }
    /// The next point to test: half-way, and half-way between the logarithms where the points lie
    /// far apart. No sum or product in it overflows or underflows.
    Real middle() const {
        const auto [low, high] = std::minmax(passes_, fails_);
        const bool decades = low > 0 && low < high / 4;
        return decades ? std::sqrt(low) * std::sqrt(high) : low + (high - low) / 2;
    }
    /// Puts the middle in the place of the point that it is like.
    void narrow(bool middle_passes) {
        const Real between = middle();
        (middle_passes ? passes_ : fails_) = between;
        --halvings_;
    }

    /// The point nearest to the border that passed.
    Real passes() const { return passes_; }
    /// The one that failed.
    Real fails() const { return fails_; }

private:
    Real passes_;
    Real fails_;
    Real tolerance_;
    int halvings_;
};

/// The largest x, but for a relative `tolerance`, with passes(x), where whatever is below a point
/// that passes does so too: 0 if no normal number passes, infinity if every one does.
/// @param guess  where to begin; any number
template <class Real, class Passes>
Real last_that_passes(Real guess, Real tolerance, Passes&& passes) {
    struct Untrapped {  // for what overflows at an end of the range
        std::fenv_t modes;
        Untrapped() { std::feholdexcept(&modes); }
        ~Untrapped() { std::fesetenv(&modes); }
    } untrapped;
    constexpr Real least = (std::numeric_limits<Real>::min)();
    constexpr Real most = (std::numeric_limits<Real>::max)();
    Real here = guess > least ? (std::min)(guess, most) : least;
    const bool up = passes(here);
    // Strides of 2, 2³, 2⁹ … reach any border in a few, and none is crossed by more than needed.
    for (int stride = 1; here != (up ? most : least); stride *= 3) {
        const Real there = std::clamp(std::scalbn(here, up ? stride : -stride), least, most);
        if (passes(there) != up) {
            Bisection<Real> search(up ? here : there, up ? there : here, tolerance);
            while (search.open()) search.narrow(passes(search.middle()));
            return search.passes();
        }
        here = there;
    }
    return up ? std::numeric_limits<Real>::infinity() : Real(0);
}

}  // namespace taut::detail
