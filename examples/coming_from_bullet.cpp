// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Bullet's m_kLST in N/m, measured: a weight on one link and a hanging chain in Bullet, beside
// springs of the stiffness that docs/coming_from.md says they are. Fails where it is another.

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <cmath>
#include <cstdio>

namespace {

constexpr double g = 9.81;     // m/s²
constexpr double mass = 0.01;  // of each node, kg

/// How much longer than laid out, 1 m a link, Bullet's chain hangs after 20 s, m.
double sag(int links, double kLST, int iterations, double h) {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    auto& info = world.getWorldInfo();
    info.air_density = info.water_density = 0;
    info.m_gravity = {0, 0, btScalar(-g)};
    world.setGravity(info.m_gravity);

    btSoftBody body(&info);
    body.appendMaterial()->m_kLST = btScalar(kLST);
    for (int i = 0; i <= links; ++i) {
        body.appendNode({0, 0, btScalar(-i)}, i == 0 ? 0 : btScalar(mass));
    }
    for (int i = 0; i < links; ++i) body.appendLink(i, i + 1);
    body.m_cfg.collisions = 0;
    body.m_cfg.kDP = btScalar(0.02);  // to come to rest
    body.m_cfg.piterations = iterations;
    body.setActivationState(DISABLE_DEACTIVATION);
    world.addSoftBody(&body);
    for (int i = 0; i < 20 / h; ++i) world.stepSimulation(btScalar(h), 0);
    const double z = static_cast<double>(body.m_nodes[links].m_x.z());
    world.removeSoftBody(&body);
    return -links - z;
}

/// Of one link whose ends have the inverse masses' sum W, 1/kg, N/m.
double stiffness_of(double kLST, int iterations, double h, double W) {
    return (std::pow(1 - kLST, -iterations) - 1) / (h * h * W);
}

}  // namespace

int main() {
    bool all_true = true;
    for (const double kLST : {0.1, 0.5, 0.9}) {
        for (const int iterations : {1, 4}) {
            for (const double h : {1.0 / 60, 1.0 / 240}) {
                const double k = stiffness_of(kLST, iterations, h, 1 / mass);
                const double stretch = mass * g / k;  // m, of 1 m: in float too little is noise
                if (stretch < 1e-5) continue;
                const double ratio = sag(1, kLST, iterations, h) / stretch;
                std::printf(
                    "one link, m_kLST %.1f, %d iterations of 1/%.0f s: %8.4g N/m; sag %.3f\n", kLST,
                    iterations, 1 / h, k, ratio);
                all_true &= std::abs(ratio - 1) < 0.02;
            }
        }
    }
    for (const int iterations : {5, 10}) {
        const double k = iterations * mass * 3600;
        const double ratio = sag(80, 1, iterations, 1.0 / 60) / (mass * g / k * 80 * 81 / 2);
        std::printf("80 links, m_kLST 1, %2d iterations of 1/60 s: %.3g N/m; sag %.2f\n",
                    iterations, k, ratio);
        all_true &= std::abs(ratio - 1) < 0.15;
    }
    return all_true ? 0 : 1;
}
