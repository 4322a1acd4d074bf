// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "planner.hpp"
#include "spring_table.hpp"

namespace taut::step_detail {

/// The springs of one law in stars, and the forces of these.
template <class Scalar, class Law>
class StarPlan {
    using Set = SpringSet<Scalar, Law>;
    using Point = Quad<Scalar>;
    using Register = typename Planner<Scalar>::StarRegister;
    using Table = SpringTable<Scalar, Law>;
    using Reader = SpringReader<Scalar, Law, Register>;
    static constexpr int group = Planner<Scalar>::group;
    static constexpr int registers = group * star_size / Register::width;
    /// The springs of a group, a lane each.
    using Lanes = Few<Register, registers>;

public:
    StarPlan() = default;
    TAUT_COLD StarPlan(const Set& set, const SortedSprings& springs, const Blocks& blocks);

    /// Adds the forces of the tile's stars; then those on its places are complete.
    /// @tparam Both  as of LawPlan::add_forces
    template <bool Damped, bool Both>
    void add_forces(const TileView<Scalar>& view) const;

private:
    using Vectors = Few<Point, star_size>;
    template <int... i>
    using Numbers = std::integer_sequence<int, i...>;
    static constexpr std::make_integer_sequence<int, star_size> all_tips{};

    /// What lies in other blocks goes behind the last place of this one.
    static int inside(int place, int end) { return place < 0 || place >= end ? end : place; }
    static Few<Star, group> within_block(const Star* stars, int end) {
        Few<Star, group> result;
        for (int s = 0; s < group; ++s) {
            result[s].hub = inside(stars[s].hub, end);
            for (int k = 0; k < star_size; ++k) result[s].tips[k] = inside(stars[s].tips[k], end);
        }
        return result;
    }
    /// Tips minus hub.
    template <int... k>
    static EIGEN_ALWAYS_INLINE Vectors differences(const Scalar* points, const Star& star,
                                                   Numbers<k...>) {
        const Point hub = Point::load(points + star.hub);
        return {(Point::load(points + star.tips[k]) - hub)...};
    }
    static EIGEN_ALWAYS_INLINE Point dots(const Vectors& a, const Vectors& b) {
        return Point::sums(a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]);
    }
    static EIGEN_ALWAYS_INLINE Lanes lanes(const Few<Point, group>& points) {
        if constexpr (group == 2) {
            return {join(points[0].part[0], points[1].part[0])};
        } else {
            return points[0].part;
        }
    }
    static EIGEN_ALWAYS_INLINE void add(Scalar* to, const Point& force) {
        (Point::load(to) + force).store(to);
    }
    static EIGEN_ALWAYS_INLINE void subtract(Scalar* from, const Point& force) {
        (Point::load(from) - force).store(from);
    }
    template <int... k>
    static EIGEN_ALWAYS_INLINE void add_star(Scalar* forces, const Star& targets,
                                             const Vectors& force, Numbers<k...>) {
        (subtract(forces + targets.tips[k], force[k]), ...);
        add(forces + targets.hub, (force[0] + force[1]) + (force[2] + force[3]));
    }

    /// What a group of stars reads and writes.
    struct Group {
        const Scalar* x;
        const Scalar* here;
        const Scalar* v;
        const Star* stars;
        const Star* targets;
        Scalar* forces;
    };
    template <bool Damped, bool Both, int... s>
    static EIGEN_ALWAYS_INLINE void add_group(Scalar alpha, Reader& springs, const Group& of,
                                              Numbers<s...>);
    /// Coefficients of the springs of a group.
    struct Pulls {
        alignas(64) Few<Scalar, group * star_size> of_dx, of_dv, of_here;
    };
    template <bool Damped, bool Both>
    static EIGEN_ALWAYS_INLINE void pull(Scalar alpha, Reader& springs, const Register& l2,
                                         const Register& dx_dv, const Register& old_l2,
                                         Pulls& pulls, int first) {
        const auto pull = springs.template pull_of<Damped, Both>(alpha, l2, dx_dv, old_l2);
        pull.of_dx.store(pulls.of_dx.data() + first);
        if constexpr (Damped) pull.of_dv.store(pulls.of_dv.data() + first);
        if constexpr (Both) pull.of_here.store(pulls.of_here.data() + first);
        springs.next();
    }
    template <bool Damped, bool Both, int... i>
    static EIGEN_ALWAYS_INLINE void pull(Scalar alpha, Reader& springs, const Lanes& l2,
                                         const Lanes& dx_dv, const Lanes& old_l2, Pulls& pulls,
                                         Numbers<i...>) {
        (pull<Damped, Both>(alpha, springs, l2[i], dx_dv[i], old_l2[i], pulls, i * Register::width),
         ...);
    }
    template <bool Damped, bool Both, int... k>
    static EIGEN_ALWAYS_INLINE Vectors forces([[maybe_unused]] Scalar alpha, const Pulls& pulls,
                                              int first, const Vectors& dx,
                                              [[maybe_unused]] const Vectors& dv,
                                              [[maybe_unused]] const Vectors& here, Numbers<k...>) {
        const auto of_dx = Point::factors(pulls.of_dx.data() + first);
        Vectors force{(of_dx[k] * dx[k])...};
        if constexpr (Both) {
            const auto of_here = Point::factors(pulls.of_here.data() + first);
            force = {(force[k] - of_here[k] * here[k])...};
        }
        if constexpr (Damped) {
            if (alpha > 0) {
                const auto of_dv = Point::factors(pulls.of_dv.data() + first);
                force = {(force[k] + of_dv[k] * dv[k])...};
            }
        }
        return force;
    }

    StarGroups plan_;
    Table table_;
};

template <class Scalar, class Law>
StarPlan<Scalar, Law>::StarPlan(const Set& set, const SortedSprings& springs,
                                const Blocks& blocks) {
    Buffer<int> index;
    plan_ = Planner<Scalar>::groups(springs, blocks, index);
    table_.add(set, index, 0, static_cast<int>(index.size()));
    table_.finish();
}

template <class Scalar, class Law>
template <bool Damped, bool Both>
void StarPlan<Scalar, Law>::add_forces(const TileView<Scalar>& view) const {
    const Index first = static_cast<Index>(view.begin) * 4;
    Group of{view.x.first + first, view.at.first + first, view.v.first + first, nullptr, nullptr,
             view.force_a.first};
    constexpr std::make_integer_sequence<int, group> all;
    int g = view.tile == 0 ? 0 : plan_.ends[view.tile - 1].all;
    Reader springs(table_, 0, static_cast<std::size_t>(g * star_size));
    const Star* stars = plan_.stars.data();
    const auto [outer, end] = plan_.ends[view.tile];
    Few<Star, group> inside_block;
    for (; g < end; g += group) {  // one loop: the kernel is most of what a program has of springs
        of.stars = of.targets = stars + g;
        if (g < outer) {
            inside_block = within_block(of.stars, 4 * view.size);
            of.targets = inside_block.data();
        }
        add_group<Damped, Both>(view.alpha, springs, of, all);
    }
}

template <class Scalar, class Law>
template <bool Damped, bool Both, int... s>
EIGEN_ALWAYS_INLINE void StarPlan<Scalar, Law>::add_group(Scalar alpha, Reader& springs,
                                                          const Group& of, Numbers<s...>) {
    const Few<Vectors, group> dx{differences(of.x, of.stars[s], all_tips)...};
    [[maybe_unused]] Few<Vectors, group> dv;
    [[maybe_unused]] Few<Vectors, group> here;
    Lanes dx_dv{}, old_l2{};
    if constexpr (Damped) {
        dv = {differences(of.v, of.stars[s], all_tips)...};
        dx_dv = lanes({dots(dx[s], dv[s])...});
    }
    if constexpr (Both) {
        here = {differences(of.here, of.stars[s], all_tips)...};
        old_l2 = lanes({dots(here[s], here[s])...});
    }
    Pulls pulls;
    pull<Damped, Both>(alpha, springs, lanes({dots(dx[s], dx[s])...}), dx_dv, old_l2, pulls,
                       std::make_integer_sequence<int, registers>());
    (add_star(of.forces, of.targets[s],
              forces<Damped, Both>(alpha, pulls, s * star_size, dx[s], dv[s], here[s], all_tips),
              all_tips),
     ...);
}

}  // namespace taut::step_detail
