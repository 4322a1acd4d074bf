// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A step that cannot gain energy, in an engine of one's own, and what the library adds to it.
// docs/never_explodes.md reads along.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>
#include <vector>

#include "common/number.hpp"

namespace own {

using Vector = Eigen::Vector3d;

struct Spring {
    int a, b;
    double k, length;  // N/m, m
};

struct Net {
    std::vector<Spring> springs;
    std::vector<double> w;     // 1/mass of each particle, 1/kg; 0 if it is pinned
    std::vector<Vector> x, v;  // m, m/s
    Vector gravity = Vector::Zero();
};

double safe_step(const Net& net) {
    std::vector<double> s(net.w.size());
    for (const Spring& p : net.springs) {
        s[p.a] += p.k * net.w[p.a];
        s[p.b] += p.k * net.w[p.b];
    }
    double most = 0;
    for (const Spring& p : net.springs) most = std::max(most, s[p.a] + s[p.b]);
    return 1 / std::sqrt(most);
}

void step(Net& net, double h) {
    std::vector<Vector> force(net.x.size(), Vector::Zero());
    for (const Spring& p : net.springs) {
        const Vector old = net.x[p.b] - net.x[p.a];
        const Vector ahead = old + h * (net.v[p.b] - net.v[p.a]);
        const double tension = p.k * (ahead.norm() - p.length);
        const Vector along = tension >= 0 ? ahead : old;
        const Vector f = tension / std::max(along.norm(), 1e-100) * along;
        force[p.a] += f;
        force[p.b] -= f;
    }
    for (std::size_t i = 0; i < net.x.size(); ++i) {
        if (net.w[i] > 0) net.v[i] += h * (net.w[i] * force[i] + net.gravity);
        net.x[i] += h * net.v[i];
    }
}

double energy(const Net& net) {
    double sum = 0;
    for (std::size_t i = 0; i < net.x.size(); ++i) {
        if (net.w[i] > 0)
            sum += (0.5 * net.v[i].squaredNorm() - net.gravity.dot(net.x[i])) / net.w[i];
    }
    for (const Spring& p : net.springs) {
        const double stretch = (net.x[p.b] - net.x[p.a]).norm() - p.length;
        sum += 0.5 * p.k * stretch * stretch;
    }
    return sum;
}

}  // namespace own

namespace {

using taut::Index;

struct Random {
    std::mt19937_64 bits;
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
    }
    own::Vector vector(double most) {
        return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
    }
};

/// Single steps out of random states: two particles, which are the hardest, or a net of twelve.
void attack(double share) {
    Random random{std::mt19937_64(1)};
    const int steps = 200000;
    int rises = 0;
    for (int i = 0; i < steps; ++i) {
        own::Net net;
        const int n = i % 2 == 0 ? 2 : 12;
        for (int p = 0; p < n; ++p) {
            net.w.push_back(p == 0 && i % 3 == 0 ? 0 : std::exp(random.uniform(-3, 3)));
        }
        for (int a = 0; a < n; ++a) {
            for (int b = a + 1; b < std::min(n, a + 4); ++b) {
                net.springs.push_back({a, b, std::exp(random.uniform(0, 8)), random.uniform(0, 2)});
            }
        }
        const double h = share * own::safe_step(net);
        for (int p = 0; p < n; ++p) {
            net.x.push_back(random.vector(1));
            net.v.push_back(net.w[static_cast<std::size_t>(p)] > 0 ? random.vector(2 / h)
                                                                   : own::Vector::Zero());
        }
        const double before = own::energy(net);
        own::step(net, h);
        rises += own::energy(net) > before * (1 + 1e-12);
    }
    std::printf("at %g of its step: %d of %d steps gain energy\n", share, rises, steps);
}

template <class Cloth>
own::Net own_net(const Cloth& cloth) {
    own::Net net;
    const auto state = cloth.initial_state();
    for (Index i = 0; i < cloth.size(); ++i) {
        net.w.push_back(cloth.inverse_mass()[i]);
        net.x.push_back(state.x.col(i));
        net.v.push_back(own::Vector::Zero());
    }
    cloth.visit_springs([&](const auto& s) {
        net.springs.push_back(
            {static_cast<int>(s.a), static_cast<int>(s.b), s.stiffness_bound(), s.rest_length});
    });
    net.gravity = cloth.gravity();
    return net;
}

/// A minute of a cloth that falls from its upper corners, without any damping.
template <class Cloth>
void minute(const char* law, const Cloth& cloth) {
    const double frame = 1.0 / 60;
    const auto lost = [&](const char* how, auto&& advance) {
        auto state = cloth.initial_state();
        const double start = cloth.energy(state);
        double most = 0;
        bool finite = true;
        for (int i = 0; i < 3600 && finite; ++i) {
            finite = advance(state) && state.finite();
            most = std::max(most, cloth.kinetic_energy(state));
        }
        const double left = 100 * (cloth.energy(state) - start) / most;
        if (left > 100) {
            std::printf("%s, a minute by %s: has exploded\n", law, how);
        } else {
            std::printf("%s, a minute by %s: %+.1f %% of its largest kinetic energy\n", law, how,
                        left);
        }
    };
    const double any = taut::any_pose_limit(cloth).certified;
    const double proved = taut::energy_limit(cloth).certified;
    taut::VelocityVerlet<Cloth> verlet(cloth);
    lost("bare Verlet", [&](auto& state) {
        const auto n = static_cast<Index>(std::ceil(frame / (0.95 * any)));
        return bool(verlet.step(state, frame / static_cast<double>(n), n));
    });
    taut::EnergyStableEuler<Cloth> stable(cloth);
    lost("the proved step alone", [&](auto& state) {
        const auto n = static_cast<Index>(std::ceil(frame / proved));
        return bool(stable.step(state, frame / static_cast<double>(n), n));
    });
    taut::Guarded guard(cloth);
    lost("the guard", [&](auto& state) { return bool(guard.advance(state, frame)); });
}

/// A flag whose pole shakes for ten seconds: what damping does to it.
template <class Cloth>
void calm(const char* how, Cloth flag, const taut::RayleighDamping& damping) {
    const double undamped = taut::energy_limit(flag).certified;
    flag.set_rayleigh(damping);
    taut::Guarded guard(flag);
    auto state = flag.initial_state();
    int trimmed = 0;
    double kinetic = 0;
    for (int frame = 0; frame < 600; ++frame) {
        for (Index i = 0; i < flag.size(); ++i) {
            if (flag.is_pinned(i)) state.v(1, i) = std::cos(5.0 * frame / 60);
        }
        const auto report = guard.advance(state, 1.0 / 60);
        trimmed += report.trimmed + report.again > 0;
        if (frame >= 300) kinetic += flag.kinetic_energy(state) / 300;
    }
    std::printf("%s: kinetic energy %.2f J, %d of 600 frames trimmed, step %.2f\n", how, kinetic,
                trimmed, taut::energy_limit(flag).certified / undamped);
}

}  // namespace

int main() {
    attack(1);
    attack(1.05);

    taut::ClothOptions options;
    options.rows = options.columns = 10;
    const auto cloth = taut::hanging_cloth<double>(options);
    own::Net net = own_net(cloth);
    const double h = own::safe_step(net);
    const double limit = taut::energy_limit(cloth).certified;
    double last = own::energy(net);
    int rises = 0;
    for (int i = 0; i < 20000; ++i) {
        own::step(net, h);
        const double now = own::energy(net);
        rises += now > last + 1e-12;
        last = now;
    }
    std::printf("cloth of 10 x 10: 20000 steps of %s s, %d gain energy\n",
                example::rounded_down(h, 3).c_str(), rises);
    std::printf("energy_limit: %s s, %.2f of that\n", example::rounded_down(limit, 3).c_str(),
                limit / h);

    minute("Hookean", cloth);
    const auto strings = taut::with_law<taut::TensionOnly>(cloth);
    minute("tension-only", strings);

    calm("undamped", strings, {});
    calm("drag of 1/s", strings, {1, 0});
    calm("alpha of a tenth of the step", strings, {0, 0.1 * limit});
    calm("both", strings, {1, 0.1 * limit});
}
