// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <limits>
#include <vector>

#include "../../model/spring_system.hpp"
#include "../../tight/detail/factor_rows.hpp"
#include "../graph_shares.hpp"

namespace taut::integrator_detail {

/// What implicit springs add to the masses [T33], [T35]: of the particles that such springs touch,
/// in an order that keeps a factor sparse.
///
///     M̃ = M + Σ s(½hc + ¼h²k)/θ L_e,   D_i = Σ δs·½hk/θ L_e,   A = M̃ + ½h D_i .
template <class System>
class GraphMatrix {
public:
    using Scalar = typename System::Scalar;
    using Vector = typename System::Vector;
    static constexpr int Dim = System::Dim;
    /// One row a touched particle.
    using Rows =
        Eigen::Matrix<Scalar, Eigen::Dynamic, Dim, Dim == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    /// @param dissipation   δ
    /// @param most_entries  nonzeros of a factor, else Status::too_large: 800 MB
    Report build(const System& system, const GraphShares& shares, double dissipation,
                 Index most_entries = 100'000'000);

    /// Particles in the matrix.
    Index size() const { return static_cast<Index>(particles_.size()); }
    /// That of row j.
    Index particle(Index j) const { return particles_[j]; }
    /// A: n × n, symmetric, both triangles, kg.
    const SparseMatrix<Scalar>& matrix() const { return matrix_; }
    /// A_ii of particle i, kg; of an untouched one its mass.
    Scalar diagonal(Index i, Scalar mass) const {
        const int row = row_.empty() ? -1 : row_[static_cast<std::size_t>(i)];
        return row < 0 ? mass : matrix_.coeff(row, row);
    }
    /// rows ← rows − D_i v.  @param v  v(i): velocity of particle i
    template <class Velocity>
    void subtract_braking(const Velocity& v, Rows& rows) const {
        if (!brakes_) return;
        for (const Link& link : links_) {
            const Vector pull = link.braking * (v(link.b) - v(link.a));
            if (link.row_a >= 0) rows.row(link.row_a) += pull.transpose();
            if (link.row_b >= 0) rows.row(link.row_b) -= pull.transpose();
        }
    }
    /// Whether a spring with a share ends at a pin.
    bool holds_pins() const { return at_pins_ < links_.size(); }
    /// rows ← rows − (A − h D_i)_fp·dv: braking acts at the mean of the velocities before and
    /// after, and subtract_braking has that after of pins.
    /// @param h   of the step, s   @param dv  dv(i): by how much the velocity of pin i changed,
    /// over h
    template <class Change>
    void subtract_pins(Scalar h, const Change& dv, Rows& rows) const {
        for_each_at_pin([&](const Link& link, Index pin, int row, Index) {
            rows.row(row) += (link.coupling - h * link.braking) * dv(pin).transpose();
        });
    }
    /// The work that moving pins do in a step through D_i, J.
    /// @param v  of the step's start   @param a  accelerations, a row a touched particle
    template <class Velocity>
    double braking_work(Scalar h, const Velocity& v, const Rows& a) const {
        if (!brakes_) return 0;
        double work = 0;
        for_each_at_pin([&](const Link& link, Index pin, int row, Index particle) {
            const Vector held = v(pin);
            if (held.isZero(0)) return;
            const Vector mean = v(particle) + h / 2 * a.row(row).transpose();
            work += static_cast<double>(h * link.braking * (held - mean).dot(held));
        });
        return work;
    }
    /// ½vᵀ(M̃ − M)v over the free particles, J.
    template <class Points>
    double added_kinetic(const Points& v) const {
        double sum = 0;
        for (const Link& link : links_) {
            Vector between = Vector::Zero();
            if (link.row_a >= 0) between -= v.col(link.a);
            if (link.row_b >= 0) between += v.col(link.b);
            sum += link.inertia / 2 * between.template cast<double>().squaredNorm();
        }
        return sum;
    }

private:
    struct Link {
        Index a, b;        // particles
        int row_a, row_b;  // or −1 when pinned
        double inertia;    // of M̃ − M, kg
        Scalar coupling;   // of A − M, kg
        Scalar braking;    // of D_i, kg/s

        bool at_pin() const { return row_a < 0 || row_b < 0; }
    };

    /// visit(link, pin, row, particle) for each spring at a pin, with its other end.
    template <class Visitor>
    void for_each_at_pin(Visitor&& visit) const {
        for (std::size_t l = at_pins_; l < links_.size(); ++l) {
            const Link& link = links_[l];
            if (link.row_a < 0) visit(link, link.a, link.row_b, link.b);
            if (link.row_b < 0) visit(link, link.b, link.row_a, link.a);
        }
    }
    void find_springs(const System& system, const GraphShares& shares, double dissipation);
    SparseMatrix<double> assemble(const System& system) const;

    std::vector<Index> particles_;  // of the rows
    std::vector<int> row_;          // of each particle, or −1
    std::vector<Link> links_;       // those at pins last
    std::size_t at_pins_ = 0;       // where these begin
    SparseMatrix<Scalar> matrix_;
    bool brakes_ = false;
};

template <class System>
void GraphMatrix<System>::find_springs(const System& system, const GraphShares& shares,
                                       double dissipation) {
    links_.clear();
    particles_.clear();
    brakes_ = dissipation > 0;
    row_.assign(static_cast<std::size_t>(system.size()), -1);
    const auto row_of = [&](Index i) {
        if (system.is_pinned(i)) return -1;
        if (row_[i] < 0) {
            row_[i] = static_cast<int>(particles_.size());
            particles_.push_back(i);
        }
        return row_[i];
    };
    for_each_inertia(system, shares, [&](Index a, Index b, double damped, double elastic) {
        if (system.is_pinned(a) && system.is_pinned(b)) return;  // with a share where all have
        links_.push_back({a, b, row_of(a), row_of(b), damped + elastic,
                          static_cast<Scalar>(damped + (1 + dissipation) * elastic),
                          static_cast<Scalar>(2 * dissipation * elastic / shares.step)});
    });
    const auto at_pins = std::stable_partition(links_.begin(), links_.end(),
                                               [](const Link& link) { return !link.at_pin(); });
    at_pins_ = static_cast<std::size_t>(at_pins - links_.begin());
}

template <class System>
SparseMatrix<double> GraphMatrix<System>::assemble(const System& system) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < size(); ++j) {
        entries.emplace_back(j, j, static_cast<double>(system.mass(particles_[j])));
    }
    for (const Link& link : links_) {
        stability_detail::add_laplacian(link.row_a, link.row_b, static_cast<double>(link.coupling),
                                        entries);
    }
    SparseMatrix<double> A(size(), size());
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

template <class System>
Report GraphMatrix<System>::build(const System& system, const GraphShares& shares,
                                  double dissipation, Index most_entries) {
    find_springs(system, shares, dissipation);
    const SparseMatrix<double> A = assemble(system);
    constexpr double lost = 64 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    for (Index j = 0; j < size(); ++j) {
        const auto mass = static_cast<double>(system.mass(particles_[j]));
        if (!(lost * A.coeff(j, j) < mass)) return {Status::masses_lost, 0, 0, particles_[j]};
    }
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order(size());
    if (size() > 0) {
        Eigen::AMDOrdering<int>()(A, order);
        order = order.inverse().eval();  // Eigen's orderings give the inverse
    }
    const auto place = [&](Index j) { return Index(order.indices()[j]); };
    if (solver_detail::factor_size(A, place, most_entries).entries > most_entries) {
        return {Status::too_large};
    }
    SparseMatrix<double> ordered;
    ordered = A.twistedBy(order);
    matrix_ = ordered.template cast<Scalar>();
    const std::vector<Index> before = particles_;
    for (Index j = 0; j < size(); ++j) {
        particles_[place(j)] = before[j];
        row_[before[j]] = static_cast<int>(place(j));
    }
    for (Link& link : links_) {
        for (int* row : {&link.row_a, &link.row_b}) {
            if (*row >= 0) *row = static_cast<int>(place(*row));
        }
    }
    return {};
}

}  // namespace taut::integrator_detail
