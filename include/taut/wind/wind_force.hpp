// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "../network/detail/outside_force.hpp"
#include "triangle_fours.hpp"
#include "triangle_pairing.hpp"
#include "triangle_rows.hpp"

namespace taut {
namespace step_detail {

/// The triangles of a wind, in rows or in fours.
template <class Scalar>
struct WindPlan final : TilePlan<Scalar> {
    TriangleRows<Scalar> rows;
    TriangleFours<Scalar> fours;
    bool points;

    WindPlan(const std::vector<Triangle>& triangles, const PlacedParticles& particles)
        : points(particles.points) {
        const Blocks& blocks = particles.blocks;
        std::vector<PlacedTriangle> placed;
        for (const auto& [a, b, c] : triangles) {
            placed.push_back({particles.place[a], particles.place[b], particles.place[c]});
            const auto [low, high] =
                std::minmax_element(placed.back().begin(), placed.back().end());
            this->reach_ = (std::max)(this->reach_, blocks.of(*high) - blocks.of(*low));
        }
        if (points) {
            fours = {pair_triangles(placed), blocks};
        } else {
            rows = {pair_triangles(placed), blocks};
        }
    }
};

}  // namespace step_detail

namespace network_detail {

inline constexpr char set_wind_name[] = "set_wind";

/// The force of a Wind.
template <class Scalar>
class WindForce final : public OutsideForce<Scalar, 3> {
public:
    using Base = OutsideForce<Scalar, 3>;
    using typename Base::Plan;
    using Triangles = std::shared_ptr<const std::vector<Triangle>>;

    /// @param triangles  in place of those of `wind`
    WindForce(const Wind<Scalar>& wind, Triangles triangles)
        : air_(wind), triangles_(std::move(triangles)) {}
    /// The same with another velocity, m/s.
    WindForce(const WindForce& other, const Eigen::Matrix<Scalar, 3, 1>& velocity)
        : WindForce(other) {
        air_.three_velocities = Scalar(3) * velocity;
    }
    /// The wind among outside forces, or null.
    static const WindForce* of(const Base* force) {
        const bool is_wind = force && force->name() == set_wind_name;
        return is_wind ? static_cast<const WindForce*>(force) : nullptr;
    }

    const char* name() const override { return set_wind_name; }
    void add(const State<Scalar, 3>& state, Points<Scalar, 3>& f) const override {
        add_wind(air_, *triangles_, state.x, state.v, f);
    }
    bool shares_plan(const Base& other) const override {
        const WindForce* wind = of(&other);
        return wind && wind->triangles_ == triangles_;
    }
    std::shared_ptr<const Plan> plan(const step_detail::PlacedParticles& particles) const override {
        return std::make_shared<WindPlan>(*triangles_, particles);
    }
    void add(const Plan& plan, const step_detail::TileView<Scalar>& view) const override {
        const auto& own = static_cast<const WindPlan&>(plan);
        const step_detail::WindView<Scalar> tile{view, air_};
        own.points ? own.fours.add_forces(tile) : own.rows.add_forces(tile);
    }

private:
    using WindPlan = step_detail::WindPlan<Scalar>;

    Air<Scalar> air_;
    Triangles triangles_;
};

}  // namespace network_detail
}  // namespace taut
