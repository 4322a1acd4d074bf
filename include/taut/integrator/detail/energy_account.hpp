// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "energy_books.hpp"

namespace taut::integrator_detail {

/// What a guard allows.
struct EnergyTerms {
    double slack = 0;  ///< share of the scale by which the energy may exceed the account
    double drift = 0;  ///< 1/s, share of the scale by which the account grows
    double swing = 1;  ///< C: E = T + V may swing by this factor while the kept energy stands still
    double yield = 1;  ///< by how much E may rise for each joule of work

    /// Of steps of at most `share` of the any-pose limit [T36].
    /// @param own  the stepper's own damping, share of its step
    static EnergyTerms of(Method method, double share, double own, double slack, double drift) {
        const double braked = own * share * share;
        const method::EnergyBand kept = method::visit(method, [&](auto descriptor) {
            return decltype(descriptor)::energy_band(share, braked);
        });
        const double least = std::max(1e-9, kept.least);
        return {slack, drift, kept.most / least, 1 / least};
    }
};

/// One account for a whole run, never re-based on what a frame has reached. It has two sides.
///
/// The *debt* is what the energy that the method keeps at its h exceeds all that was there, was
/// worked and was granted by drift: it stays until that energy falls or the drift covers it. It
/// finds gains early. The *grant* bounds E = T + V itself, which no choice of h moves: C times the
/// E of any accepted frame, and the yield of the work since.
class EnergyAccount {
public:
    /// One frame, for judgement.
    struct Frame {
        EnergyBooks start;
        EnergyBooks end;
        Method method;
        double h;           ///< s
        double span;        ///< s
        double work;        ///< by everything outside, J
        double in_doubt;    ///< of this, by forces that the steps do not resolve, J
        double unresolved;  ///< what these may have added or lost by their change with x, J
        double thrown;      ///< what they throw back in a step by their change with v, J
    };
    /// J; what exceeds the account, how much of that is in doubt, and how much is allowed.
    struct Verdict {
        double rise = 0;
        double in_doubt = 0;
        double allowed = 0;
        bool admitted = false;
    };

    /// Opens the account with the state that the first frame starts from.
    void open(const EnergyBooks& start, const EnergyTerms& terms) {
        *this = {};
        grant_ = terms.swing * start.owned();
        opened_ = true;
    }
    bool opened() const { return opened_; }
    /// Somebody has made `before`, the last frame's end, into `after`: the debt stays, the grant
    /// moves by C times the change of E at the most, and not above C·E.
    void edit(const EnergyBooks& before, const EnergyBooks& after, const EnergyTerms& terms) {
        const double was = before.owned();
        const double is = after.owned();
        const double left = is < was ? grant_ * (is / was) : grant_;
        grant_ = std::min(terms.swing * is, left + terms.swing * std::abs(is - was));
        lag_ += after.lag(method_, h_) - before.lag(method_, h_);
    }
    /// Whether the frame may stand; the account itself does not change.
    Verdict judge(const Frame& frame, const EnergyTerms& terms) const {
        Verdict verdict;
        verdict.allowed = terms.slack * scale(frame) + frame.start.rounding + frame.end.rounding;
        const double above = (frame.end.owned() - granted(frame, terms)) / terms.yield;
        verdict.rise = std::max(kept_rise(frame), above);
        verdict.in_doubt = frame.unresolved + frame.thrown - thrown_;
        verdict.admitted = verdict.rise <= verdict.allowed;
        return verdict;
    }
    /// The frame stands.
    void settle(const Frame& frame, const EnergyTerms& terms) {
        const double grown = terms.drift * frame.span * scale(frame);
        debt_ = std::max(0.0, kept_rise(frame) - grown);
        thrown_ = frame.thrown;
        grant_ =
            std::min(granted(frame, terms) + terms.yield * grown, terms.swing * frame.end.owned());
        scale_ = scale(frame);
        method_ = frame.method;
        h_ = frame.h;
        lag_ = frame.end.lag(method_, h_);
    }

private:
    static constexpr double memory = 10;  // s

    double kept_rise(const Frame& frame) const {
        return frame.end.kept(frame.method, frame.h) - frame.start.kept(frame.method, frame.h) +
               debt_ - frame.work + frame.unresolved + frame.thrown - thrown_;
    }
    /// What E may be at the end of the frame, by work that counts as the kept energy counts it.
    double granted(const Frame& frame, const EnergyTerms& terms) const {
        const double lag = h_ > 0 ? lag_ : frame.start.lag(frame.method, frame.h);
        const double work = frame.work + frame.start.gravity - frame.end.gravity -
                            (frame.end.lag(frame.method, frame.h) - lag);
        return grant_ + terms.yield * work;
    }
    /// The largest E of late, which falls by a factor e in ten seconds; with what fell and was
    /// worked within the frame, which its ends may not show.
    double scale(const Frame& frame) const {
        const double fallen = std::max(0.0, frame.start.gravity - frame.end.gravity);
        const double moved = frame.start.owned() + fallen + std::abs(frame.work - frame.in_doubt);
        return std::max(moved, scale_ * std::exp(-frame.span / memory));
    }

    double debt_ = 0;    // J, of the energy that the method keeps
    double grant_ = 0;   // J, of E
    double thrown_ = 0;  // J, in the last frame
    double scale_ = 0;   // J
    double lag_ = 0;     // J, at the end of the last frame
    double h_ = 0;       // s, of the last frame
    Method method_ = Method::implicit_euler;
    bool opened_ = false;
};

}  // namespace taut::integrator_detail
