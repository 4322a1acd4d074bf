// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "../contact/contact.hpp"
#include "graph_inertia.hpp"

namespace taut {
namespace integrator_detail {

/// The impulses that keep particles of graph inertia from moving into surfaces: normal ones first,
/// then friction. None of them adds to ½vᵀAv.
template <class Stepper>
class GraphContacts {
public:
    using Scalar = typename Stepper::Scalar;
    using State = typename Stepper::State;
    using Field = decltype(State::v);
    using Vector = Eigen::Matrix<Scalar, Field::RowsAtCompileTime, 1>;

    explicit GraphContacts(Stepper& stepper) : stepper_(stepper) {}

    /// @param normal  unit, the way out
    void add(Index particle, const Vector& normal) {
        particles_.push_back(particle);
        normals_.push_back(normal);
    }
    /// v ← v + A⁻¹Jᵀλ with λ ≥ 0 and, at each contact, n·v ≥ 0 but for a millionth of the largest
    /// speed, where five passes reach that. @returns Σ λn, N·s
    Vector stop(Field& v);
    /// Coulomb's: impulses against the tangential velocities, each at most μλ. @returns their sum
    Vector rub(Field& v, Scalar friction);

private:
    using Values = VectorX<Scalar>;

    Index size() const { return static_cast<Index>(particles_.size()); }
    Field along_normals(const Values& impulse) const {
        Field p = Field::Zero(Field::RowsAtCompileTime, columns_);
        for (Index c = 0; c < size(); ++c) p.col(particles_[c]) += impulse[c] * normals_[c];
        return p;
    }
    Values speeds(const Field& v) const {
        Values out(size());
        for (Index c = 0; c < size(); ++c) out[c] = normals_[c].dot(v.col(particles_[c]));
        return out;
    }
    /// One pass of stop().
    void push(Field& v);
    /// Impulses of the active contacts that stop them, by conjugate gradients.
    Values solve(const Values& speed, const std::vector<char>& active) const;

    Stepper& stepper_;
    std::vector<Index> particles_;
    std::vector<Vector> normals_;
    Values lambda_;
    Index columns_ = 0;
};

template <class Stepper>
auto GraphContacts<Stepper>::solve(const Values& speed, const std::vector<char>& active) const
    -> Values {
    const auto restrict = [&](Values& values) {
        for (Index c = 0; c < size(); ++c) {
            if (!active[static_cast<std::size_t>(c)]) values[c] = 0;
        }
    };
    Values lambda = Values::Zero(size());
    Values r = -speed;
    restrict(r);
    // 1/A_ii is about what a contact alone would give way by.
    Values heavy(size());
    for (Index c = 0; c < size(); ++c) heavy[c] = stepper_.inertia(particles_[c]);
    Values z = heavy.cwiseProduct(r);
    Values p = z;
    Scalar rz = r.dot(z);
    const Scalar enough = Scalar(1e-12) * rz;
    for (int repeat = 0; repeat < 100 && rz > enough; ++repeat) {
        Values Wp = speeds(stepper_.response_to(along_normals(p)));
        restrict(Wp);
        const Scalar t = rz / p.dot(Wp);
        lambda += t * p;
        r -= t * Wp;
        z = heavy.cwiseProduct(r);
        const Scalar next = r.dot(z);
        p = z + next / rz * p;
        rz = next;
    }
    return lambda;
}

template <class Stepper>
auto GraphContacts<Stepper>::stop(Field& v) -> Vector {
    columns_ = v.cols();
    lambda_ = Values::Zero(size());
    const Scalar enough = Scalar(-1e-6) * speeds(v).cwiseAbs().maxCoeff();
    for (int pass = 0; pass < 5 && speeds(v).minCoeff() < enough; ++pass) push(v);
    return along_normals(lambda_).rowwise().sum();
}

template <class Stepper>
void GraphContacts<Stepper>::push(Field& v) {
    Values lambda = Values::Zero(size());
    const Values into = speeds(v);
    std::vector<char> active(static_cast<std::size_t>(size()));
    for (Index c = 0; c < size(); ++c) active[c] = into[c] < 0;
    for (int repeat = 0; repeat < 6; ++repeat) {
        lambda = solve(into, active);
        const Values after = into + speeds(stepper_.response_to(along_normals(lambda)));
        bool settled = true;
        for (Index c = 0; c < size(); ++c) {
            const bool pulls = lambda[c] < 0;
            const bool sinks = !active[c] && after[c] < 0;
            settled = settled && !pulls && !sinks;
            if (pulls) active[c] = false;
            if (sinks) active[c] = true;
        }
        if (settled) break;
    }
    lambda = lambda.cwiseMax(Scalar(0));
    const Field dv = stepper_.response_to(along_normals(lambda));
    // What is left of the solves must not add energy: no further than to its least along this way.
    const Scalar downhill = -lambda.dot(into);
    const Scalar uphill = lambda.dot(speeds(dv));
    if (!(downhill > 0)) return;
    const Scalar share = std::min(Scalar(1), downhill / uphill);
    lambda_ += share * lambda;
    v += share * dv;
}

template <class Stepper>
auto GraphContacts<Stepper>::rub(Field& v, Scalar friction) -> Vector {
    Vector sum = Vector::Zero();
    Values left = friction * lambda_;
    for (int round = 0; round < 4; ++round) {
        Field p = Field::Zero(v.rows(), v.cols());
        for (Index c = 0; c < size(); ++c) {
            const Vector at = v.col(particles_[c]);
            const Vector along = at - normals_[c].dot(at) * normals_[c];
            const Scalar speed = along.norm();
            if (!(speed > 0) || !(left[c] > 0)) continue;
            const Scalar stops = stepper_.inertia(particles_[c]) * speed;
            p.col(particles_[c]) -= std::min(left[c], stops) / speed * along;
        }
        const Field dv = stepper_.response_to(p);
        const Scalar downhill = -p.cwiseProduct(v).sum();
        const Scalar uphill = p.cwiseProduct(dv).sum();
        if (!(downhill > 0)) break;
        const Scalar share = std::min(Scalar(1), downhill / uphill);
        v += share * dv;
        sum += share * p.rowwise().sum();
        for (Index c = 0; c < size(); ++c) left[c] -= share * p.col(particles_[c]).norm();
    }
    return sum;
}

}  // namespace integrator_detail

/// Puts the free particles of a state out of an obstacle at rest, as resolve_contacts(system, …)
/// does, after a step of graph inertia: velocities change by A⁻¹Jᵀλ, all touched particles
/// together [T33], so that ½vᵀAv does not rise. Changing the particle alone, as the other one does,
/// would feed the scene energy.
///
/// Contacts of one call are solved together by conjugate gradients: tens of solves, hundreds where
/// thousands touch. Without dissipation ½vᵀAv is kinetic energy and what added_kinetic() says. The
/// report's impulse is Σ Jᵀλ, what the obstacle bears.
/// @param stepper  that has just stepped the state
template <class System, class Solver, class Obstacle>
ContactReport<typename System::Scalar, System::Dim> resolve_contacts(
    GraphInertia<System, Solver>& stepper, const Obstacle& obstacle, typename System::State& state,
    const ContactOptions& options = {}) {
    using Scalar = typename System::Scalar;
    (void)stepper.renew();
    if (stepper.touched() == 0) {
        return resolve_contacts(stepper.system(), obstacle, state, options);
    }
    integrator_detail::GraphContacts<GraphInertia<System, Solver>> contacts(stepper);
    auto report =
        scene_detail::lift_out(stepper.system(), obstacle, state, options,
                               [&](Index i, const auto& normal) { contacts.add(i, normal); });
    if (report.contacts == 0) return report;
    report.impulse = contacts.stop(state.v);
    report.impulse += contacts.rub(state.v, static_cast<Scalar>(options.friction));
    return report;
}

}  // namespace taut
