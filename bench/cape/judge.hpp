// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "frames.hpp"

namespace bench {

/// What is seen of a cape after each frame, whoever moves it.
class Judge {
public:
    static constexpr const char* columns =
        "frame, ms: median | worst | seen, s | deepest, mm | frames with a particle deeper than 1 "
        "mm | such particles at most | l/L: largest | 99 % | fastest, m/s | trouble";
    static constexpr const char* rule = "---|---|---|---|---|---|---|---|---|---";
    /// By then the skirt, which begins inside the thighs, is out; the figure still stands.
    static constexpr int start = 30;  // frames

    explicit Judge(const Cloth& cloth) : cloth_(cloth), x_(cloth.initial_state().x) {}

    /// @param ms  that the frame took   @param x  at its end, m
    void see(double ms, const example::Figure& figure, const taut::Points<float, 3>& x) {
        ++frames_;
        if (frames_ > 1) times_.push_back(ms);
        if (!x.allFinite()) {
            finite_ = false;
            return;
        }
        const auto way = (x - x_).colwise().norm().maxCoeff();
        x_ = x;
        exploded_ = exploded_ || way > lost_way;
        if (frames_ <= start) return;
        see_stretch(x);
        fastest_ = std::max(fastest_, double(way / frame));
        see_depth(figure, x);
    }
    /// A frame was refused.
    void give_up() { refused_ = true; }
    bool lost() const { return !finite_ || refused_ || exploded_; }

    /// The cells below `columns`.
    std::string cells() const {
        auto times = times_;
        std::sort(times.begin(), times.end());
        const char* trouble = refused_    ? "a frame was refused"
                              : !finite_  ? "not finite"
                              : exploded_ ? "exploded"
                                          : "–";
        char text[200];
        std::snprintf(text, sizeof text,
                      "%.2f | %.2f | %.0f | %.3f | %d | %d | %.3f | %.3f | %.1f | %s",
                      times.empty() ? 0 : times[times.size() / 2], times.empty() ? 0 : times.back(),
                      double(frame) * frames_, 1e3 * std::max(0.0, deepest_), deep_frames_,
                      most_deep_, widest_, percentile(0.99), fastest_, trouble);
        return text;
    }

private:
    static constexpr float lost_way = 10;  // of a particle in a frame, m
    static constexpr int bins = 4000;      // of l/L, a thousandth each

    void see_stretch(const taut::Points<float, 3>& x) {
        for (const auto spring : cloth_.springs<taut::TensionOnly>()) {
            if (cloth_.is_pinned(spring.a) && cloth_.is_pinned(spring.b)) continue;
            const double ratio =
                double((x.col(spring.a) - x.col(spring.b)).norm() / spring.rest_length);
            widest_ = std::max(widest_, ratio);
            ++counts_[std::size_t(std::min(1000 * ratio, bins - 1.0))];
        }
    }
    /// An l/L that so many springs do not exceed, of all frames.
    double percentile(double share) const {
        double all = 0, sum = 0;
        for (const double count : counts_) all += count;
        std::size_t bin = 0;
        while (bin + 1 < counts_.size() && (sum += counts_[bin]) < share * all) ++bin;
        return double(bin) / 1000;
    }
    void see_depth(const example::Figure& figure, const taut::Points<float, 3>& x) {
        int deep = 0;
        for (taut::Index i = 0; i < cloth_.size(); ++i) {
            if (cloth_.is_pinned(i)) continue;
            const double below = double(example::depth_of(figure, x.col(i)));
            deepest_ = std::max(deepest_, below);
            deep += below > 1e-3;
        }
        deep_frames_ += deep > 0;
        most_deep_ = std::max(most_deep_, deep);
    }

    const Cloth& cloth_;
    taut::Points<float, 3> x_;   // m
    std::vector<double> times_;  // ms, without the first
    std::vector<double> counts_ = std::vector<double>(bins);
    int frames_ = 0, deep_frames_ = 0, most_deep_ = 0;
    double deepest_ = -1, widest_ = 0, fastest_ = 0;
    bool finite_ = true, refused_ = false, exploded_ = false;
};

}  // namespace bench
