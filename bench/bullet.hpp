// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <memory>

#include "outcome.hpp"

namespace bench {

/// What both of Bullet's worlds share: the net as a btSoftBody without collisions, air or damping.
/// Bullet computes in float, as Debian and the others deliver it.
class BulletBody {
protected:
    explicit BulletBody(const Net& net) : net_(net), state_(net.initial_state()) {}

    static btVector3 vector(const Eigen::Vector3d& u) {
        return {static_cast<btScalar>(u.x()), static_cast<btScalar>(u.y()),
                static_cast<btScalar>(u.z())};
    }
    /// @param bending  stiffness of the springs to be marked as bending
    btSoftBody* make_body(btSoftBodyWorldInfo& info, double bending) {
        info.air_density = 0;
        info.water_density = 0;
        info.m_gravity = vector(net_.gravity());
        body_ = std::make_unique<btSoftBody>(&info);
        body_->appendMaterial()->m_kLST = 1;
        for (taut::Index i = 0; i < net_.size(); ++i) {
            body_->appendNode(vector(state_.x.col(i)),
                              net_.is_pinned(i) ? 0 : static_cast<btScalar>(net_.mass(i)));
        }
        const auto& springs = net_.springs();
        for (std::size_t s = 0; s < springs.a.size(); ++s) {
            body_->appendLink(static_cast<int>(springs.a[s]), static_cast<int>(springs.b[s]));
            const bool bends = springs.parameters[s].stiffness == bending;
            body_->m_links[body_->m_links.size() - 1].m_bbending = bends ? -1 : 0;
        }
        body_->m_cfg.collisions = 0;
        body_->setActivationState(DISABLE_DEACTIVATION);
        return body_.get();
    }

public:
    BulletBody(const BulletBody&) = delete;
    BulletBody& operator=(const BulletBody&) = delete;

    const Net::State& state() {
        for (int i = 0; i < body_->m_nodes.size(); ++i) {
            const auto& node = body_->m_nodes[i];
            for (int d = 0; d < 3; ++d) {
                state_.x(d, i) = static_cast<double>(node.m_x[d]);
                state_.v(d, i) = static_cast<double>(node.m_v[d]);
            }
        }
        return state_;
    }

protected:
    btSoftBody* body() { return body_.get(); }

    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;

private:
    const Net& net_;
    Net::State state_;
    std::unique_ptr<btSoftBody> body_;
};

/// The classic soft body: positions moved towards the rest lengths link by link. All it has of the
/// springs' stiffness is m_kLST in [0, 1]; 1, the stiffest, is its default.
class BulletSoftBody : public BulletBody {
public:
    BulletSoftBody(const Net& net, int iterations) : BulletBody(net) {
        btSoftBody* made = make_body(world_.getWorldInfo(), 0);
        made->m_cfg.piterations = iterations;
        world_.setGravity(world_.getWorldInfo().m_gravity);
        world_.addSoftBody(made);
    }
    ~BulletSoftBody() { world_.removeSoftBody(body()); }
    taut::Index advance(double frame) {
        world_.stepSimulation(static_cast<btScalar>(frame), 0);
        return 1;
    }

protected:
    btSoftRigidDynamicsWorld& world() { return world_; }

private:
    btSequentialImpulseConstraintSolver solver_;
    btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

/// The deformable world: implicit steps of springs with the net's own stiffness, which may have two
/// values.
class BulletDeformable : public BulletBody {
public:
    BulletDeformable(const Net& net, double stiffness, double bending)
        : BulletBody(net),
          springs_(static_cast<btScalar>(stiffness), 0, true, bending),
          gravity_(vector(net.gravity())) {
        constraints_.setDeformableSolver(&solver_);
        btSoftBody* made = make_body(world_.getWorldInfo(), bending);
        world_.setImplicit(true);
        world_.setLineSearch(false);
        world_.setUseProjection(true);  // with its other solver nothing moves
        world_.setGravity(vector(net.gravity()));
        world_.addSoftBody(made);
        world_.addForce(made, &springs_);
        world_.addForce(made, &gravity_);
    }
    ~BulletDeformable() { world_.removeSoftBody(body()); }
    taut::Index advance(double frame) {
        world_.stepSimulation(static_cast<btScalar>(frame), 1, static_cast<btScalar>(frame));
        return 1;
    }

private:
    btDeformableMassSpringForce springs_;
    btDeformableGravityForce gravity_;
    btDeformableMultiBodyConstraintSolver constraints_;
    btDeformableBodySolver solver_;
    btDeformableMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &constraints_,
                                              &configuration_, &solver_};
};

}  // namespace bench
