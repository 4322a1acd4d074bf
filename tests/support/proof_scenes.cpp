// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "proof_scenes.hpp"

#include "scene_on.hpp"

namespace taut_test {

namespace {

/// `make` makes a system of a scalar.
template <class Make>
Scene scene_of(const Make& make) {
    const auto system = make();
    using System = std::decay_t<decltype(system)>;
    Scene scene({std::is_same_v<typename System::Scalar, float>, System::Dim, Laws::hookean});
    dynamic_cast<SceneOn<System>&>(scene.base()).system = system;
    return scene;
}

template <class Scalar>
Scene chain_of(int dim, const taut::ChainOptions& options) {
    if (dim == 1) return scene_of([&] { return taut::chain<Scalar, 1>(options); });
    if (dim == 2) return scene_of([&] { return taut::chain<Scalar, 2>(options); });
    return scene_of([&] { return taut::chain<Scalar, 3>(options); });
}

struct Posed {
    std::string text;
    Scene scene;
    AnyState state;
};

std::vector<Posed> posed_scenes(bool single) {
    using taut::ChainEnds;
    std::vector<Posed> all;
    const auto pose = [&](const char* text, const Scene& scene, const AnyState& state) {
        all.push_back({text, scene, state});
    };
    const auto at_rest = [&](const char* text, const Scene& scene) {
        pose(text, scene, scene.initial_state());
    };
    taut::ChainOptions options;
    options.masses = 5;
    options.mass = 0.1;
    options.stiffness = 300;
    const auto chain = [&](int dim, ChainEnds ends) {
        options.ends = ends;
        return chain_scene(single, dim, options);
    };
    at_rest("chain 1d, fixed-fixed", chain(1, ChainEnds::fixed_fixed));
    at_rest("chain 1d, fixed-free", chain(1, ChainEnds::fixed_free));
    at_rest("chain 1d, free-free", chain(1, ChainEnds::free_free));
    at_rest("ring 1d", chain(1, ChainEnds::ring));
    at_rest("ring 2d", chain(2, ChainEnds::ring));
    at_rest("chain 3d, fixed-free", chain(3, ChainEnds::fixed_free));
    const auto row = chain(2, ChainEnds::fixed_fixed);
    pose("chain 2d, stretched", row, deformed(row, 1.5, 0.02, 1));
    pose("chain 2d, compressed", row, deformed(row, 0.8, 0.02, 2));
    at_rest("chain 3d, zero rest length", at_zero_length(chain(3, ChainEnds::fixed_fixed)));
    options.spacing = 0;
    at_rest("chain 1d, all in one point", chain(1, ChainEnds::fixed_free));
    at_rest("chain 2d, all in one point", chain(2, ChainEnds::free_free));
    options.spacing = 1;
    options.stiffness = 0;
    at_rest("chain 2d, no stiffness", at_zero_length(chain(2, ChainEnds::fixed_free)));

    Scene alone({single, 3, Laws::hookean});
    alone.add_particle(Eigen::Vector3d(1, 2, 3), 0.5);
    at_rest("a single particle", alone);
    Scene one({single, 1, Laws::hookean});
    one.add_particle(Eigen::VectorXd::Constant(1, 0), 1);
    one.add_particle(Eigen::VectorXd::Constant(1, 1), 0.01);
    one.add_spring({0, 1, 1e4, 1});
    one.pin(0);
    at_rest("one mass on one spring", one);
    one.pin(1);
    at_rest("everything pinned", one);

    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = 3;
    const auto grid = cloth_scene(cloth, single);
    at_rest("cloth, flat", grid);
    pose("cloth, stretched", grid, deformed(grid, 1.1, 0.01, 3));
    pose("cloth, compressed", grid, deformed(grid, 0.9, 0.01, 4));
    pose("cloth, crumpled", grid, deformed(grid, 0.3, 0.3, 5));
    cloth.pin_corners = false;
    cloth.rows = 2;
    const auto flying = cloth_scene(cloth, single);
    at_rest("cloth, free-flying", flying);
    pose("cloth, free-flying and wrinkled", flying, deformed(flying, 1.02, 0.05, 6));
    cloth.diagonals = false;
    cloth.pin_corners = true;
    at_rest("grid of zero rest length", at_zero_length(cloth_scene(cloth, single)));
    return all;
}

}  // namespace

Scene chain_scene(bool single, int dim, const taut::ChainOptions& options) {
    return single ? chain_of<float>(dim, options) : chain_of<double>(dim, options);
}

Scene cloth_scene(const taut::ClothOptions& options, bool single) {
    if (single) return scene_of([&] { return taut::hanging_cloth<float>(options); });
    return scene_of([&] { return taut::hanging_cloth<double>(options); });
}

Scene with_springs(const Scene& scene, const std::function<void(AnySpring&)>& change) {
    Scene copy(scene.kind());
    const auto x = scene.initial_state().x;
    for (Index i = 0; i < scene.size(); ++i) {
        copy.add_particle(x.col(i), scene.mass(i));
        if (scene.is_pinned(i)) copy.pin(i);
    }
    for (AnySpring spring : scene.springs()) {
        change(spring);
        copy.add_spring(spring);
    }
    copy.set_gravity(scene.gravity());
    copy.set_rayleigh(scene.mass_proportional(), scene.stiffness_proportional());
    return copy;
}
Scene with_dampers(const Scene& scene, double ratio) {
    return with_springs(scene, [&](AnySpring& s) { s.damping = ratio * s.stiffness; });
}
Scene at_zero_length(const Scene& scene) {
    return with_springs(scene, [](AnySpring& s) { s.rest_length = 0; });
}

AnyState deformed(const Scene& scene, double factor, double noise, std::uint32_t seed) {
    Random random(seed);
    auto state = scene.initial_state();
    state.x = factor * state.x + random_points(random, scene.dim(), scene.size(), -noise, noise);
    state.x = state.x.unaryExpr([&](double x) { return scene.rounded(x); }).eval();
    return state;
}

std::vector<StabilityCase> stability_cases(bool single, bool with_damping) {
    std::vector<StabilityCase> cases;
    for (const auto& [text, scene, state] : posed_scenes(single)) {
        const Exact exact = exact_matrices(scene, state.x);
        if (!with_damping) {
            cases.push_back({text, scene, state, exact, Analysis(scene, state)});
            continue;
        }
        const double omega = Multipliers(exact).omega();
        for (const Damping& damping : dampings) {
            Scene damped = scene;
            if (damping.dampers > 0) damped = with_dampers(scene, damping.dampers / omega);
            damped.set_rayleigh(damping.d0 * omega, damping.alpha / omega);
            cases.push_back({text + ", " + damping.text, damped, state,
                             exact_matrices(damped, state.x), Analysis(damped, state)});
        }
    }
    return cases;
}

double over_decades(Random& random, double decades) {
    return log_uniform(random, std::pow(10.0, -decades), std::pow(10.0, decades));
}

Scene wild_scene(Random& random, const Kind& kind, const WildOptions& options) {
    Scene scene(kind);
    const auto size = [&] { return over_decades(random, options.decades); };
    const Index n = 2 + random.below(options.most_particles - 1);
    for (Index i = 0; i < n; ++i) {
        auto place = random_vector(random, kind.dim, -1, 1);
        if (i > 0 && random.below(12) == 0) place = scene.initial_state().x.col(i - 1);
        scene.add_particle(place, size());
    }
    const bool dampers = options.damping && random.below(2) == 0;
    const Index springs = 1 + random.below(3 * n);
    for (Index s = 0; s < springs; ++s) {
        AnySpring spring;
        spring.a = random.below(n);
        spring.b = (spring.a + 1 + random.below(n - 1)) % n;
        spring.stiffness = size();
        if (dampers && random.below(2) == 0) spring.damping = size();
        spring.rest_length = random.below(5) == 0 ? 0 : random.uniform(0, 2);
        scene.add_spring(spring);
    }
    if (options.damping && random.below(2) == 0) {
        const double d0 = random.below(3) == 0 ? 0 : size();
        scene.set_rayleigh(d0, random.below(3) == 0 ? 0 : size());
    }
    for (Index i = 0; options.pins && i + 1 < n; ++i) {
        if (random.below(5) == 0) scene.pin(i);
    }
    return scene;
}

taut::Combination wild_combination(Random& random) {
    const auto weight = [&] {
        return random.below(4) == 0 ? 0 : (random.below(2) == 0 ? 1 : -1) * over_decades(random, 2);
    };
    namespace matrices = taut::matrices;
    const double mass = weight();
    const double stiffness = weight();
    const double damping = weight();
    return mass * matrices::M + damping * matrices::D +
           stiffness * (random.below(2) == 0 ? matrices::K_plus : matrices::K);
}

RealMatrix exact_sum(const Exact& e, const taut::Combination& c) {
    RealMatrix S =
        Real(c.stiffness()) * e.K + Real(c.projected()) * e.K_plus + Real(c.damping()) * e.D;
    S.diagonal() += Real(c.mass()) * e.mass;
    return S;
}

RealVector exact_eigenvalues(const Exact& e, const taut::Combination& c) {
    const RealVector by_root = e.mass.cwiseSqrt().cwiseInverse();
    return eigenvalues(by_root.asDiagonal() * exact_sum(e, c) * by_root.asDiagonal());
}

Eigen::VectorXd random_vector(Random& random, Index n) {
    return random_vector(random, static_cast<int>(n), -1, 1);
}

Eigen::MatrixXd with_spectrum(Random& random, const Eigen::VectorXd& spectrum) {
    const Index N = spectrum.size();
    RealMatrix G(N, N);
    for (Index i = 0; i < N * N; ++i) G.data()[i] = random.uniform(-1, 1);
    const Eigen::MatrixXd Q = orthogonal(G).cast<double>();
    const Eigen::MatrixXd A = Q * spectrum.asDiagonal() * Q.transpose();
    return 0.5 * (A + A.transpose());
}

Eigen::MatrixXd random_graph(Random& random, Index n, Index degree) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (Index e = 0; e < n * degree / 2; ++e) {
        const Index i = random.below(n);
        const Index j = (i + 1 + random.below(n - 1)) % n;
        A(i, j) = A(j, i) = random.uniform(-1, 1);
    }
    A.diagonal() = 1.05 * A.cwiseAbs().rowwise().sum();
    A.diagonal().array() += 0.1;
    return A;
}

}  // namespace taut_test
