// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"
#include "resolution_scenes.hpp"

namespace taut_test::resolution {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

AnySpring spring_of(LawOf law, Index a, Index b, double k, double rest, double damping = 0) {
    AnySpring spring{a, b, k, rest, damping, law};
    if (law == LawOf::buckling) spring.second = 0.01 * k * rest * rest * rest, spring.third = k;
    return spring;
}
double length_of(const AnySpring& spring, const Eigen::MatrixXd& x) {
    return (x.col(spring.b) - x.col(spring.a)).norm();
}

Scene random_particles(Random& random, const Kind& kind, Index n) {
    Scene scene(kind);
    for (Index i = 0; i < n; ++i)
        scene.add_particle(random_vector(random, kind.dim, -1, 1), random.uniform(0.1, 1));
    return scene;
}
/// A connected random network of all its laws, some particles pinned, the first of them not.
Scene random_network(Random& random, const Kind& kind, Index n, Index pins) {
    Scene scene = random_particles(random, kind, n);
    const auto x = scene.initial_state().x;
    const auto laws = laws_of(kind);
    const auto join = [&](Index a, Index b) {
        const double k = random.uniform(10, 100);
        const double rest = (x.col(b) - x.col(a)).norm() * random.uniform(0.8, 1.2);
        const double damping = static_cast<double>(random.below(2)) * random.uniform(0, 1);
        const auto law = static_cast<std::size_t>(random.below(static_cast<Index>(laws.size())));
        scene.add_spring(spring_of(laws[law], a, b, k, rest, damping));
    };
    for (Index i = 1; i < n; ++i) join(random.below(i), i);
    for (Index s = 0; s < 2 * n; ++s) {
        const Index a = random.below(n), b = random.below(n);
        if (a != b) join(a, b);
    }
    for (Index p = 0; p < pins; ++p) scene.pin(1 + (p * 7) % (n - 1));
    return scene;
}

/// Every pair's distance along the springs, by Floyd and Warshall. A spring of half the median's
/// k l leads √2 times as far.
Eigen::MatrixXd distances(const Scene& scene) {
    const Index n = scene.size();
    const auto x = scene.initial_state().x;
    Eigen::MatrixXd length = Eigen::MatrixXd::Constant(n, n, infinity);
    length.diagonal().setZero();
    const auto springs = scene.springs();
    std::vector<double> strengths;
    for (const auto& spring : springs)
        strengths.push_back(static_cast<double>(law_at(spring, 1).bound) * length_of(spring, x));
    auto sorted = strengths;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const double softer = std::sqrt(std::max(1.0, median / strengths[s]));
        double& known = length(springs[s].a, springs[s].b);
        known = std::min(known, softer * length_of(springs[s], x));
        length(springs[s].b, springs[s].a) = known;
    }
    for (Index via = 0; via < n; ++via)
        for (Index i = 0; i < n; ++i)
            length.row(i) = length.row(i).cwiseMin(
                Eigen::RowVectorXd((length(i, via) + length.row(via).array()).matrix()));
    return length;
}

template <class Trial>
void for_each_trial(std::uint32_t seed, int trials, Trial&& try_one) {
    for (const Kind& kind : kinds) {
        Random random(seed);
        for (int trial = 0; trial < trials; ++trial) {
            CAPTURE(kind, trial);
            try_one(random, kind, trial);
        }
    }
}

}  // namespace

TEST_CASE("coarsen: seeds are the farthest along the springs, clusters the nearest to them",
          "[resolution]") {
    for_each_trial(3, 20, [](Random& random, const Kind& kind, int) {
        const double tolerance = kind.single ? 1e-5 : 1e-12;
        const Index n = 5 + random.below(30), pins = 1 + random.below(3);
        const Scene scene = random_network(random, kind, n, pins);
        const auto length = distances(scene);
        const auto coarse = coarsen(scene, 3 + random.below(n - 3));
        Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, infinity);
        for (std::size_t s = 0; s < coarse.seeds.size(); ++s) {
            const bool pinned = static_cast<Index>(s) < pins;
            CHECK(coarse.system.is_pinned(static_cast<Index>(s)) == pinned);
            if (!pinned) CHECK(nearest[coarse.seeds[s]] >= nearest.maxCoeff() - tolerance);
            nearest = nearest.cwiseMin(length.col(coarse.seeds[s]));
        }
        for (Index i = 0; i < n; ++i)
            CHECK(length(i, coarse.seeds[coarse.cluster[i]]) <= nearest[i] + tolerance);
    });
}

TEST_CASE("coarsen: mass, momentum, constant forces and factors are kept", "[resolution]") {
    for_each_trial(5, 10, [](Random& random, const Kind& kind, int trial) {
        const Index n = 10 + random.below(50);
        Scene scene = random_network(random, kind, n, trial % 3);
        scene.set_gravity(random_vector(random, kind.dim, -10, 10));
        scene.set_rayleigh(0.3, 2e-3);
        for (int f = 0; f < 5; ++f)
            scene.set_constant_force(random.below(n), random_vector(random, kind.dim, -1, 1));
        const auto coarse = coarsen(scene, 4 + random.below(n - 4));
        auto state = scene.initial_state();
        state.v = random_points(random, kind.dim, n, -1, 1);
        state.time = 0.5;
        const auto reduced = coarse.restricted(state);
        Eigen::VectorXd momentum = Eigen::VectorXd::Zero(kind.dim);
        double mass = 0;
        for (Index i = 0; i < n; ++i) {
            mass += scene.mass(i);
            if (!coarse.system.is_pinned(coarse.cluster[i]))
                momentum += scene.mass(i) * state.v.col(i);
        }
        for (Index c = 0; c < coarse.system.size(); ++c) {
            mass -= coarse.system.mass(c);
            CHECK(reduced.x.col(c) == state.x.col(coarse.seeds[c]));
            if (coarse.system.is_pinned(c)) {
                CHECK(reduced.v.col(c) == state.v.col(coarse.seeds[c]));
            } else {
                momentum -= coarse.system.mass(c) * reduced.v.col(c);
            }
        }
        const double tolerance = static_cast<double>(n) * kind.rounding();
        CHECK(std::abs(mass) < tolerance);
        CHECK(momentum.norm() < tolerance);
        CHECK(reduced.time == state.time);
        CHECK(coarse.system.gravity() == scene.gravity());
        CHECK(coarse.system.stiffness_proportional() == 2e-3);
        CHECK(coarse.system.mass_proportional() == 0.3);
        // Springs pull both ends alike: what is left of all forces is gravity and the constant.
        const Eigen::MatrixXd force = scene.force(scene.initial_state());
        const Eigen::MatrixXd carried = coarse.system.force(coarse.system.initial_state());
        CHECK((force.rowwise().sum() - carried.rowwise().sum()).norm() <
              tolerance * std::max({1.0, largest(force), largest(carried)}));
    });
}

TEST_CASE("coarsen: all particles are the same network in another order", "[resolution]") {
    for_each_trial(7, 10, [](Random& random, const Kind& kind, int) {
        const Index n = 5 + random.below(20);
        // No two springs of one law join the same pair: their rest lengths would be averaged.
        Scene scene = random_particles(random, kind, n);
        const auto x = scene.initial_state().x;
        for (Index a = 0; a < n; ++a) {
            for (Index b = a + 1; b < n; ++b) {
                if (b != a + 1 && random.below(3) > 0) continue;
                const double rest = (x.col(b) - x.col(a)).norm() * random.uniform(0.8, 1.2);
                for (const LawOf law : laws_of(kind)) {
                    auto spring = spring_of(law, a, b, 7, rest, 2);
                    spring.second *= 3;
                    spring.third += 2;
                    scene.add_spring(spring);
                }
            }
        }
        const auto coarse = coarsen(scene, n);
        auto moving = scene.initial_state();
        moving.v = random_points(random, kind.dim, n, -1, 1);
        const Eigen::MatrixXd fine = scene.force(moving);
        const Eigen::MatrixXd force = coarse.system.force(coarse.restricted(moving));
        for (Index c = 0; c < n; ++c)
            CHECK(distance(force.col(c), fine.col(coarse.seeds[c])) <
                  kind.accumulated() * largest(fine));
    });
}

TEST_CASE("coarsen: a spring stores, damps and strains as what it stands for, stretched along AB",
          "[resolution]") {
    for_each_trial(13, 6, [](Random& random, const Kind& kind, int) {
        if (kind.laws == Laws::strings) return;
        const Index n = 30 + random.below(30);
        Scene scene = random_particles(random, kind, n);
        const auto x = scene.initial_state().x;
        for (Index i = 1; i < n; ++i) {
            const Index a = random.below(i);
            const double l = (x.col(i) - x.col(a)).norm();
            const double k = random.uniform(10, 100);
            scene.add_spring({a, i, k, l / 1.25, k / 16});
        }
        const auto coarse = coarsen(scene, 5 + random.below(10));
        // Between A and B each crossing spring stands for L_AB/(l |cos θ|) of its kind, since
        // those of a volume cross a plane in proportion to l |cos θ|. A strain ε along AB
        // stretches it by ε l cos² θ.
        std::map<std::pair<Index, Index>, double> energy;  // J/ε²
        for (const auto& spring : scene.springs()) {
            const Index a = coarse.cluster[spring.a], b = coarse.cluster[spring.b];
            if (a == b) continue;
            const Eigen::VectorXd d = x.col(spring.b) - x.col(spring.a);
            const Eigen::VectorXd AB = x.col(coarse.seeds[b]) - x.col(coarse.seeds[a]);
            const double along = std::abs(d.dot(AB)) / AB.norm();
            const double stretch = along * along / d.norm();
            energy[std::minmax(a, b)] +=
                spring.stiffness * stretch * stretch / 2 * (AB.norm() / along);
        }
        CHECK(coarse.system.spring_count() == static_cast<Index>(energy.size()));
        for (const auto& spring : coarse.system.springs()) {
            const double L = length_of(spring, coarse.system.initial_state().x);
            CHECK_THAT(spring.stiffness * L * L / 2,
                       WithinRel(energy[std::minmax(spring.a, spring.b)], kind.accumulated()));
            CHECK_THAT(L / spring.rest_length, WithinRel(1.25, kind.accumulated()));
            CHECK_THAT(16 * spring.damping, WithinRel(spring.stiffness, kind.accumulated()));
        }
    });
}

TEST_CASE("coarsen: a lift weighs the four nearest of the seeds that springs lead to",
          "[resolution]") {
    for_each_trial(17, 6, [](Random& random, const Kind& kind, int) {
        const Index n = 20 + random.below(80), count = 4 + random.below(n - 4);
        const Scene scene = random_network(random, kind, n, 2);
        const auto x = scene.initial_state().x;
        const auto coarse = coarsen(scene, count);
        Eigen::MatrixXd joined = Eigen::MatrixXd::Identity(count, count), weights(count, n);
        for (const auto& spring : scene.springs()) {
            const Index a = coarse.cluster[spring.a], b = coarse.cluster[spring.b];
            joined(a, b) = joined(b, a) = 1;
        }
        for (Index i = 0; i < n; ++i) {
            const Index own = coarse.cluster[i];
            Eigen::VectorXd d(count);
            for (Index c = 0; c < count; ++c)
                d[c] = joined(own, c) > 0 ? (x.col(coarse.seeds[c]) - x.col(i)).norm() : infinity;
            std::vector<double> near(d.data(), d.data() + count);
            std::sort(near.begin(), near.end());
            const auto candidates = static_cast<std::size_t>(joined.row(own).sum());
            // ((R − d)/(R d))², where one that comes in as the fourth begins at 0.
            const double R = candidates > 4 ? near[4] : 2 * near[candidates - 1];
            const Eigen::ArrayXd roots = (1 / d.array() - 1 / R).max(0);
            weights.col(i) = roots.square() / roots.square().sum();
            if (coarse.seeds[own] == i) weights.col(i) = Eigen::VectorXd::Unit(count, own);
        }
        const auto u = random_points(random, kind.dim, count, -1, 1);
        const auto fine = coarse.lifted(u);
        CHECK(distance(fine, u * weights) < kind.accumulated());
        for (Index c = 0; c < count; ++c) CHECK(fine.col(coarse.seeds[c]) == u.col(c));
    });
}

TEST_CASE("coarsen: a smaller count's seeds come first among a larger one's", "[resolution]") {
    Random random(19);
    const Scene scene = random_network(random, {false, 2}, 200, 5);
    const auto most = coarsen(scene, 200).seeds;
    CHECK(std::set<int>(most.begin(), most.end()).size() == 200);
    for (const Index count : {5, 6, 20, 100, 199}) {
        const auto seeds = coarsen(scene, count).seeds;
        CHECK(std::equal(seeds.begin(), seeds.end(), most.begin()));
    }
}

TEST_CASE("coarsen: each part keeps a particle, and springs without length do no harm",
          "[resolution]") {
    Scene scene({false, 3});
    for (int part = 0; part < 3; ++part)
        for (int i = 0; i < 10; ++i) {
            const Index added = scene.add_particle(Eigen::Vector3d(i * 0.1, part, 0), 0.1);
            if (i > 0) scene.add_spring({added - 1, added, 50, 0.1});
        }
    // Two seams: particles that lie on each other, joined by springs of no length.
    for (const Index i : {4, 5}) {
        const Index twin = scene.add_particle(scene.initial_state().x.col(i), 0.1);
        scene.add_spring({i, twin, 1000, 0});
        scene.add_spring({twin, i + 1, 50, 0.1});
    }
    scene.pin(4);
    for (const Index count : {3, 8, 31, 32}) {
        const auto coarse = coarsen(scene, count);
        std::set<int> parts;
        for (const int seed : coarse.seeds) parts.insert(seed < 30 ? seed / 10 : 0);
        CHECK(parts.size() == 3);
        CHECK(coarse.system.initial_state().x.allFinite());
        Index glued = 0;
        for (const auto& spring : coarse.system.springs()) {
            CHECK(std::isfinite(spring.stiffness));
            CHECK(std::isfinite(spring.rest_length));
            glued += spring.rest_length == 0;
        }
        if (count == 32) CHECK(glued == 2);
    }
    CHECK(least_count(scene) == 3);
    CHECK(missing(message_of([&] { coarsen(scene, 2); }), {"count is 2", "at least 3"}) == "");
}

TEST_CASE("coarsen: slack and taut threads between the same ends stay apart", "[resolution]") {
    Scene threads({false, 3, Laws::strings});
    for (const double x : {0.0, 1.0}) threads.add_particle(Eigen::Vector3d(x, 0, 0), 1);
    for (const double rest : {0.7, 1.3})
        threads.add_spring(spring_of(LawOf::tension_only, 0, 1, 20, rest));
    const Scene coarse = coarsen(threads, 2).system;
    CHECK(coarse.spring_count() == 2);
    CHECK_THAT(std::abs(coarse.force(coarse.initial_state())(0, 0)), WithinRel(6, 1e-12));
}

TEST_CASE("coarsen: bad input: counts and forces that cannot be carried over",
          "[resolution][bad_input]") {
    Random random(23);
    Scene scene = random_network(random, {false, 3}, 30, 4);
    const auto refused = [&](Index count, std::initializer_list<const char*> words) {
        return missing(message_of([&] { coarsen(scene, count); }), words);
    };
    CHECK(refused(0, {"coarsen", "count is 0", "30 particles"}) == "");
    CHECK(refused(-3, {"count is -3"}) == "");
    CHECK(refused(31, {"count is 31", "30 particles"}) == "");
    CHECK(refused(3, {"count is 3", "4 pins"}) == "");
    scene.set_external_force([](const AnyState&, Eigen::MatrixXd&) {});
    CHECK(refused(10, {"coarsen", "set_external_force"}) == "");
    scene.set_external_force({});
    set_wind(scene, {{0, 1, 2}});
    CHECK(refused(10, {"coarsen", "set_wind"}) == "");
    set_wind(scene, {});
    const auto coarse = coarsen(scene, 10);
    CHECK(missing(message_of([&] { coarse.lifted(Eigen::MatrixXd::Zero(3, 9)); }),
                  {"lifted", "9 columns", "10 particles"}) == "");
    auto state = scene.initial_state();
    state.x.conservativeResize(3, 29);
    CHECK(missing(message_of([&] { coarse.restricted(state); }), {"restricted", "29"}) == "");
    scene = Scene({false, 3});
    CHECK(refused(1, {"no particles"}) == "");
    for (int i = 0; i < 3; ++i) scene.add_particle(Eigen::Vector3d::Zero(), 1);
    scene.add_spring({0, 2, 10, 0.5});
    CHECK(refused(3, {"particles 0 and 2", "initial_state", "0.5 m"}) == "");
}

}  // namespace taut_test::resolution
