// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>

#include <cstdio>
#include <deque>
#include <string>
#include <vector>

#include "../bullet.hpp"
#include "frames.hpp"

namespace bench {

/// The springs of a system as Hooke's, which push: Bullet and Jolt have no others.
template <class System>
Net net_of(const System& system) {
    Net net;
    const auto state = system.initial_state();
    for (taut::Index i = 0; i < system.size(); ++i) {
        net.add_particle(state.x.col(i).template cast<double>(), double(system.mass(i)));
        if (system.is_pinned(i)) net.pin(i);
    }
    system.for_each_set([&](const auto& springs) {
        for (const auto spring : springs)
            net.add_spring(
                taut::Spring<double, taut::Hookean>{spring.a,
                                                    spring.b,
                                                    {double(spring.parameters.stiffness)},
                                                    double(spring.rest_length),
                                                    0});
    });
    net.set_gravity(system.gravity().template cast<double>());
    net.set_rayleigh(system.rayleigh());
    return net;
}

/// What a user of Bullet's soft body sets for contact.
struct BulletSettings {
    int iterations = 1;     // of positions a step
    taut::Index steps = 1;  // a frame
    float hardness = 0.1f;  // kKHR, of contacts with bodies that are moved
    float voxel = 0.25f;    // of the field of distances, m

    std::string name() const {
        char text[100];
        std::snprintf(text, sizeof text, "%d × %d iterations, kKHR %g, voxel %g m", int(steps),
                      iterations, double(hardness), double(voxel));
        return text;
    }
};

/// Bullet's classic soft body on kinematic bodies. A spring of less than `soft` N/m is as soft
/// beside the stiffest as it should be, as far as links can be: in proportion.
class BulletOnBodies : public BulletSoftBody {
public:
    BulletOnBodies(const Net& net, const BulletSettings& settings, const std::vector<Round>& bodies,
                   const Places& at, const Touch& touch = {}, float seconds = frame)
        : BulletSoftBody(net, settings.iterations),
          steps_(settings.steps),
          dt_(seconds / float(settings.steps)) {
        world().getWorldInfo().m_sparsesdf.setDefaultVoxelsz(settings.voxel);
        world().getWorldInfo().m_sparsesdf.Reset();
        btSoftBody& cloth = *body();
        double stiffest = 0;
        for (const auto spring : net.springs())
            stiffest = std::max(stiffest, spring.parameters.stiffness);
        btSoftBody::Material* bending = nullptr;
        for (int s = 0; s < cloth.m_links.size(); ++s) {
            const double share = net.springs().parameters[std::size_t(s)].stiffness / stiffest;
            if (share == 1) continue;
            if (!bending) bending = cloth.appendMaterial();
            bending->m_kLST = btScalar(share);
            cloth.m_links[s].m_material = bending;
        }
        cloth.getCollisionShape()->setMargin(touch.thickness);
        cloth.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
        cloth.m_cfg.kDF = touch.friction;
        cloth.m_cfg.kKHR = settings.hardness;
        cloth.m_cfg.kDP = btScalar(net.rayleigh().mass_proportional) * dt_;
        for (std::size_t k = 0; k < bodies.size(); ++k) add(bodies[k], at[k]);
    }
    ~BulletOnBodies() {
        for (auto& moved : moved_) world().removeRigidBody(&moved.body);
    }
    void advance(const Places& from, const Places& to, const std::vector<PinAt>& pins = {}) {
        std::vector<taut::contact_detail::Way<float, 3>> ways;
        for (std::size_t k = 0; k < moved_.size(); ++k) ways.emplace_back(from[k], to[k]);
        for (taut::Index step = 0; step < steps_; ++step) {
            for (std::size_t k = 0; k < moved_.size(); ++k) {
                moved_[k].body.setWorldTransform(
                    transform(ways[k](float(step + 1) / float(steps_)), moved_[k].in_bone));
            }
            for (const PinAt& pin : pins) {
                auto& node = body()->m_nodes[int(pin.particle)];
                const btVector3 target(pin.x.x(), pin.x.y(), pin.x.z());
                node.m_v = (target - node.m_x) / (dt_ * float(steps_ - step));
            }
            world().stepSimulation(dt_, 0);
        }
    }

private:
    struct Moved {
        Moved(const Round& round, float length)
            : shape(round.radius, length),
              body(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape)) {}
        btCapsuleShape shape;  // along its y
        btRigidBody body;
        Place in_bone;
    };
    static btTransform transform(const Place& bone, const Place& in_bone) {
        const Eigen::Matrix3f R = bone.rotation * in_bone.rotation;
        const Eigen::Vector3f p = bone(in_bone.position);
        return btTransform(btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2),
                                       R(2, 0), R(2, 1), R(2, 2)),
                           btVector3(p.x(), p.y(), p.z()));
    }
    void add(const Round& round, const Place& at) {
        const Eigen::Vector3f axis = round.b - round.a;
        Moved& moved = moved_.emplace_back(round, axis.norm());
        moved.in_bone.position = (round.a + round.b) / 2;
        if (axis.norm() > 0) {
            moved.in_bone.rotation =
                Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitY(), axis)
                    .toRotationMatrix();
        }
        btRigidBody& body = moved.body;
        body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setActivationState(DISABLE_DEACTIVATION);
        body.setFriction(1);  // Bullet multiplies it with the cloth's
        const btTransform place = transform(at, moved.in_bone);
        body.setWorldTransform(place);
        body.setInterpolationWorldTransform(place);
        world().addRigidBody(&body);
    }

    taut::Index steps_;
    float dt_;  // s
    std::deque<Moved> moved_;
};

}  // namespace bench
