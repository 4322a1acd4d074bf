// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "../../core/types.hpp"
#include "spring_values.hpp"

namespace taut::detail {

/// The particles of a sweep come in blocks of this many, whatever the number of threads. A spring
/// between two blocks is evaluated in both, so that each block writes to its own particles only.
inline constexpr int block_size = 1024;
/// Fewer springs of one offset are not worth a run.
inline constexpr int shortest_run = 16;

/// Plane d of one vector a particle: d·stride scalars after the first plane.
template <class Scalar>
struct Planes {
    Scalar* first = nullptr;
    Index stride = 0;
    Scalar* operator[](int d) const { return first + d * stride; }
};

/// What a sweep over the springs of one block reads and writes.
template <class Scalar>
struct BlockSweep {
    Planes<const Scalar> x;  // m, of all particles
    Planes<const Scalar> v;  // m/s
    Scalar alpha;            // Rayleigh's factor of K⁺, s
    int block;
    /// Forces on the block's particles, N; where springs begin and where they end. Apart, because
    /// a register stored to one place and loaded from the next would wait for the store.
    Planes<Scalar> begin_force;
    Planes<Scalar> end_force;
    Planes<Scalar> foreign_force;  // on particles of other blocks: written, never read
};

/// A spring of a set with its ends in the plan's numbering, a < b.
struct NumberedSpring {
    int a;
    int b;
    int index;

    friend bool operator<(const NumberedSpring& s, const NumberedSpring& t) {
        return std::tuple(s.b - s.a, s.a, s.index) < std::tuple(t.b - t.a, t.a, t.index);
    }
};

/// The springs of a set as cut by numbering: those of a run [first, last) have consecutive a.
struct SpringRuns {
    std::vector<NumberedSpring> springs;  // by offset, then by a
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    std::vector<NumberedSpring> rest;  // by a
    
    template <class Set, class Number>
    SpringRuns(const Set& set, const Number& number) {
        springs.reserve(set.a.size());
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = number(set.a[s]);
            const int b = number(set.b[s]);
            springs.push_back({std::min(a, b), std::max(a, b), static_cast<int>(s)});
        }
        std::sort(springs.begin(), springs.end());
        for (std::size_t first = 0, last = 0; first < springs.size(); first = last) {
            for (last = first + 1; last < springs.size() && follows(springs[last - 1], springs[last]);) ++last;
            if (last - first >= shortest_run) {
                runs.push_back({first, last});
            } else {
                rest.insert(rest.end(), springs.begin() + first, springs.begin() + last);
            }
        }
    }
    static bool follows(const NumberedSpring& s, const NumberedSpring& t) {
        return t.a == s.a + 1 && t.b == s.b + 1;
    }
};

/// The springs of one law in the order of a sweep: runs of one offset b − a and consecutive a, which
/// need no index and no gather, and lists of the others.
template <class Scalar, int Dim, class Law>
class SpringPlan {
    using Pack = Lanes<Scalar>;
    using Values = SpringValues<Scalar, Law>;
    static constexpr int width = Pack::size;

public:
    using Set = SpringSet<Scalar, Law>;

    SpringPlan() = default;
    SpringPlan(const Set& set, const SpringRuns& runs, int blocks);

    bool damped() const { return damped_; }
    /// Adds the forces on the particles of the sweep's block.
    template <bool Rayleigh>
    void add_forces(const BlockSweep<Scalar>& sweep) const {
        damped_ ? add_forces<true, Rayleigh>(sweep) : add_forces<false, Rayleigh>(sweep);
    }

private:
    /// Springs a, a + 1, … of one run whose ends lie in the block, in other blocks, or in both.
    struct Segment {
        int run;
        int a;
        int count;
        bool begins;  // in the block
        bool ends;
    };
    struct Run {
        int a;
        int offset;
        typename Values::Slice values;
    };
    struct List {
        std::size_t first;
        std::size_t count;
        typename Values::Slice values;
    };
    using Vectors = std::array<Pack, Dim>;

    template <bool Dampers, bool Rayleigh>
    void add_forces(const BlockSweep<Scalar>& sweep) const;
    template <bool Dampers, bool Rayleigh>
    void add_segment(const BlockSweep<Scalar>& sweep, const Segment& segment) const;
    template <bool Dampers, bool Rayleigh>
    void add_list(const BlockSweep<Scalar>& sweep, const List& list) const;
    template <bool Dampers, bool Rayleigh>
    void pull(const typename Values::Slice& slice, std::size_t i, Scalar alpha, const Vectors& dx,
              const Vectors& dv, Vectors& force) const;

    std::vector<Run> runs_;
    std::vector<Segment> segments_;          // block by block
    std::vector<std::size_t> segment_end_;   // of each block
    std::vector<List> lists_;                // one a block
    std::vector<int> a_, b_;                 // ends of the lists' springs
    Values values_;
    bool damped_ = false;
};

template <class Scalar, int Dim, class Law>
SpringPlan<Scalar, Dim, Law>::SpringPlan(const Set& set, const SpringRuns& runs, int blocks)
    : damped_(!set.damping.empty()) {
    std::vector<std::vector<Segment>> segments(blocks);
    std::vector<int> index;
    const auto add_values = [&](auto begin, auto end) {
        index.clear();
        for (; begin != end; ++begin) index.push_back(begin->index);
        return values_.add(set, index.data(), index.size());
    };
    for (const auto& [first, last] : runs.runs) {
        const auto begin = runs.springs.begin() + first;
        const auto end = runs.springs.begin() + last;
        const int run = static_cast<int>(runs_.size());
        const int offset = begin->b - begin->a;
        runs_.push_back({begin->a, offset, add_values(begin, end)});
        // A piece ends where its springs begin or end in another block.
        const int a_end = (end - 1)->a + 1;
        for (int a = begin->a; a < a_end;) {
            const int block_a = a / block_size;
            const int block_b = (a + offset) / block_size;
            const int next = std::min({a_end, (block_a + 1) * block_size,
                                       (block_b + 1) * block_size - offset});
            segments[block_a].push_back({run, a, next - a, true, block_a == block_b});
            if (block_a != block_b) segments[block_b].push_back({run, a, next - a, false, true});
            a = next;
        }
    }
    for (const auto& block : segments) {
        segments_.insert(segments_.end(), block.begin(), block.end());
        segment_end_.push_back(segments_.size());
    }

    std::vector<std::vector<NumberedSpring>> rest(blocks);
    for (const auto& spring : runs.rest) {
        const int block_a = spring.a / block_size;
        const int block_b = spring.b / block_size;
        rest[block_a].push_back(spring);
        if (block_a != block_b) rest[block_b].push_back(spring);
    }
    for (auto& block : rest) {
        lists_.push_back({a_.size(), block.size(), {}});
        if (!block.empty()) lists_.back().values = add_values(block.begin(), block.end());
        for (const auto& spring : block) {
            a_.push_back(spring.a);
            b_.push_back(spring.b);
        }
    }
    values_.finish();
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh>
void SpringPlan<Scalar, Dim, Law>::add_forces(const BlockSweep<Scalar>& sweep) const {
    const auto block = static_cast<std::size_t>(sweep.block);
    for (std::size_t s = block == 0 ? 0 : segment_end_[block - 1]; s < segment_end_[block]; ++s) {
        add_segment<Dampers, Rayleigh>(sweep, segments_[s]);
    }
    add_list<Dampers, Rayleigh>(sweep, lists_[block]);
}

/// The force on the end a of springs i, i + 1, … of a slice, one a lane.
template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh>
void SpringPlan<Scalar, Dim, Law>::pull(const typename Values::Slice& slice, std::size_t i,
                                        Scalar alpha, const Vectors& dx, const Vectors& dv,
                                        Vectors& force) const {
    Pack l2 = dx[0] * dx[0];
    for (int d = 1; d < Dim; ++d) l2 += dx[d] * dx[d];
    // Kept from zero, a spring of no length has no direction, and so no force.
    const Pack least(std::numeric_limits<Scalar>::min());
    const Pack safe_l2 = max(l2, least);
    const Pack over_l = reciprocal_sqrt(safe_l2);
    const Pack l = safe_l2 * over_l;
    const Pack tension = values_.evaluate(
        slice, i, [](const auto& p, auto L, auto l) { return Law::tension(p, L, l); }, l);
    const Pack tension_over_l = tension * over_l;
    for (int d = 0; d < Dim; ++d) force[d] = tension_over_l * dx[d];
    if constexpr (Dampers || Rayleigh) {
        Vectors direction;
        for (int d = 0; d < Dim; ++d) direction[d] = over_l * dx[d];
        Pack stretching = direction[0] * dv[0];
        for (int d = 1; d < Dim; ++d) stretching += direction[d] * dv[d];
        if constexpr (Dampers) {
            const Pack damping = values_.damping(slice, i) * stretching;
            for (int d = 0; d < Dim; ++d) force[d] += damping * direction[d];
        }
        if constexpr (Rayleigh) {
            const Pack slope = values_.evaluate(
                slice, i, [](const auto& p, auto L, auto l) { return Law::tension_slope(p, L, l); },
                l);
            const Pack bound = values_.evaluate(
                slice, i, [](const auto& p, auto L) { return Law::stiffness_bound(p, L); });
            const Pack zero(Scalar(0));
            const Pack transverse = where_less(zero, l2, max(tension_over_l, zero), bound);
            const Pack along = (max(slope, zero) - transverse) * stretching;
            const Pack factor(alpha);
            for (int d = 0; d < Dim; ++d) {
                force[d] += factor * (transverse * dv[d] + along * direction[d]);
            }
        }
    }
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh>
void SpringPlan<Scalar, Dim, Law>::add_segment(const BlockSweep<Scalar>& sweep,
                                               const Segment& segment) const {
    const Run& run = runs_[segment.run];
    const int first = sweep.block * block_size;
    const auto& begin_force = segment.begins ? sweep.begin_force : sweep.foreign_force;
    const auto& end_force = segment.ends ? sweep.end_force : sweep.foreign_force;
    const int begin_shift = segment.begins ? segment.a - first : 0;
    const int end_shift = segment.ends ? segment.a + run.offset - first : 0;
    Planes<const Scalar> x = sweep.x;
    Planes<const Scalar> v = sweep.v;
    const auto advance = [&](int i, auto keep) {
        const int a = segment.a + i;
        const int b = a + run.offset;
        Vectors dx, dv, force;
        for (int d = 0; d < Dim; ++d) dx[d] = Pack::load(x[d] + b) - Pack::load(x[d] + a);
        if constexpr (Dampers || Rayleigh) {
            for (int d = 0; d < Dim; ++d) dv[d] = Pack::load(v[d] + b) - Pack::load(v[d] + a);
        }
        pull<Dampers, Rayleigh>(run.values, static_cast<std::size_t>(a - run.a), sweep.alpha, dx, dv,
                                force);
        for (int d = 0; d < Dim; ++d) {
            const Pack f = keep(force[d]);
            Scalar* at_a = begin_force[d] + begin_shift + i;
            Scalar* at_b = end_force[d] + end_shift + i;
            (Pack::load(at_a) + f).store(at_a);
            (Pack::load(at_b) - f).store(at_b);
        }
    };
    int i = 0;
    for (; i + width <= segment.count; i += width) {
        advance(i, [](const Pack& f) { return f; });
    }
    if (i < segment.count) {
        // Beyond the segment's end the lanes hold springs that are not there.
        advance(i, [&](const Pack& f) { return f.head(segment.count - i); });
    }
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh>
void SpringPlan<Scalar, Dim, Law>::add_list(const BlockSweep<Scalar>& sweep,
                                            const List& list) const {
    constexpr int chunk = 64;  // springs between the gather and the scatter
    static_assert(chunk % most_lanes == 0);
    const unsigned first = static_cast<unsigned>(sweep.block) * block_size;
    Scalar dx[Dim][chunk] = {};
    [[maybe_unused]] Scalar dv[Dim][chunk] = {};
    for (std::size_t done = 0; done < list.count; done += chunk) {
        const int* a = a_.data() + list.first + done;
        const int* b = b_.data() + list.first + done;
        const int count = static_cast<int>(std::min<std::size_t>(chunk, list.count - done));
        for (int d = 0; d < Dim; ++d) {
            const Scalar* x = sweep.x[d];
            for (int s = 0; s < count; ++s) dx[d][s] = x[b[s]] - x[a[s]];
            if constexpr (Dampers || Rayleigh) {
                const Scalar* v = sweep.v[d];
                for (int s = 0; s < count; ++s) dv[d][s] = v[b[s]] - v[a[s]];
            }
        }
        for (int s = 0; s < count; s += width) {
            Vectors dx_s, dv_s, force;
            for (int d = 0; d < Dim; ++d) dx_s[d] = Pack::load(dx[d] + s);
            if constexpr (Dampers || Rayleigh) {
                for (int d = 0; d < Dim; ++d) dv_s[d] = Pack::load(dv[d] + s);
            }
            pull<Dampers, Rayleigh>(list.values, done + static_cast<std::size_t>(s), sweep.alpha,
                                    dx_s, dv_s, force);
            for (int d = 0; d < Dim; ++d) force[d].store(dx[d] + s);
        }
        for (int s = 0; s < count; ++s) {
            // Particles of other blocks share the place after the block's last.
            const unsigned at_a = std::min<unsigned>(static_cast<unsigned>(a[s]) - first, block_size);
            const unsigned at_b = std::min<unsigned>(static_cast<unsigned>(b[s]) - first, block_size);
            for (int d = 0; d < Dim; ++d) {
                sweep.begin_force[d][at_a] += dx[d][s];
                sweep.begin_force[d][at_b] -= dx[d][s];
            }
        }
    }
}

}  // namespace taut::detail
