// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The weighted splitting bound of SpringPencil [T26].

namespace taut {

template <int Dim>
auto SpringPencil<Dim>::splitting(const Combination& c, const std::vector<double>& p) const
    -> Splitting {
    Splitting split;
    split.block.assign(degree_.size(), Block::Zero());
    split.rounding.assign(degree_.size(), 0);
    // The factor of every K⁺: where it is not positive, neither is any transverse coefficient,
    // whatever the rounding of the tangents.
    const double factor = c.projected() + c.damping() * rayleigh_.stiffness_proportional;
    const double eps = std::numeric_limits<double>::epsilon();
    for (const Link& link : links_) {
        const auto [axial, transverse] = extreme_coefficients(c, link, 1);
        const double size = magnitude(c, link);
        if (c.stiffness() == 0 && factor <= 0 && (c.damping() <= 0 || axial < -64 * eps * size)) {
            continue;  // not positive for certain
        }
        const Block P = spring_block(link.d, std::max(axial, 0.0), std::max(transverse, 0.0));
        const auto add = [&](int i, int other) {
            if (i < 0) return;
            const double weight = other < 0 ? 1 : 1 + p[other] / p[i];
            split.block[i] += weight * P;
            split.rounding[i] += weight * size;
        };
        add(link.a, link.b);
        add(link.b, link.a);
    }
    for (std::size_t i = 0; i < split.rounding.size(); ++i) {
        double& size = split.rounding[i];
        if (size > 0) {
            size = std::max(size * (degree_[i] + 64) * eps, std::numeric_limits<double>::min());
        }
    }
    return split;
}

/// An upper bound on the largest eigenvalue of each block, N/m.
template <int Dim>
std::vector<double> SpringPencil<Dim>::loads(const Splitting& split) const {
    std::vector<double> load(split.block.size());
    for (std::size_t i = 0; i < load.size(); ++i) {
        load[i] = stability_detail::eigenvalue_upper_bound<Dim>(split.block[i]) + split.rounding[i];
    }
    return load;
}

/// The largest load over mass, 1/s². One small factorisation settles most particles of a
/// regular scene.
template <int Dim>
double SpringPencil<Dim>::largest_quotient(const Splitting& split) const {
    double largest = 0;
    for (std::size_t i = 0; i < split.block.size(); ++i) {
        const double below =
            largest * mass_[static_cast<Index>(Dim * i)] * (1 - 1e-15) - split.rounding[i];
        if (stability_detail::proved_above<Dim>(split.block[i], below)) continue;
        const double r = quotient(
            stability_detail::eigenvalue_upper_bound<Dim>(split.block[i]) + split.rounding[i], i);
        if (!(r <= largest)) largest = r;  // NaN and infinity stay
    }
    return largest;
}

template <int Dim>
double SpringPencil<Dim>::upper_bound(const Combination& c, double enough) const {
    constexpr int most_repeats = 40;
    constexpr double worth_repeating = 1e-3;  // of the bound, over five repeats
    std::vector<double> p(degree_.size());
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = 1 / std::sqrt(mass_[Dim * i]);
    Splitting split = splitting(c, p);
    double best = largest_quotient(split);
    if (!std::isfinite(best)) return std::numeric_limits<double>::infinity();
    double earlier = best;
    for (int repeat = 1; repeat <= most_repeats && best > std::max(0.0, enough); ++repeat) {
        // A particle whose bound is far below the largest must not lose all its weight at once.
        const std::vector<double> load = loads(split);
        std::vector<double> r(load.size());
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = quotient(load[i], i);
        const double largest = *std::max_element(r.begin(), r.end());
        for (std::size_t i = 0; i < p.size(); ++i) {
            p[i] *= std::sqrt(std::max(r[i] / largest, 1e-4));
        }
        split = splitting(c, p);
        best = std::min(best, largest_quotient(split));
        if (repeat % 5 == 0) {
            if (best > earlier * (1 - worth_repeating)) break;
            earlier = best;
        }
    }
    const double rounding = 1 + 16 * std::numeric_limits<double>::epsilon();
    return best * rounding +
           mass_coefficient(c) * (mass_coefficient(c) > 0 ? rounding : 1 / rounding);
}

}  // namespace taut
