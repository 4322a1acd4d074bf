// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <taut/lattice/lattice.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/scene_of.hpp"
#include "../support/proof_scenes.hpp"

namespace taut_test::lattice_test {

using taut::ChainEnds;
using taut::ChainOptions;
using taut::LatticeOptions;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr auto all_ends = {ChainEnds::fixed_fixed, ChainEnds::fixed_free, ChainEnds::free_free,
                           ChainEnds::ring};

/// Theory's closed forms, ascending, in 1/s², each `times`.
RealVector closed_form(const ChainOptions& options, int times = 1) {
    const Real pi = std::acos(-1.0L);
    const auto n = static_cast<int>(options.masses);
    std::vector<Real> k;
    for (int j = 0; j < n; ++j) {
        Real angle = 0;
        switch (options.ends) {
            case ChainEnds::fixed_fixed: angle = (j + 1) * pi / (2 * (n + 1)); break;
            case ChainEnds::fixed_free: angle = (2 * j + 1) * pi / (2 * (2 * n + 1)); break;
            case ChainEnds::free_free: angle = j * pi / (2 * n); break;
            case ChainEnds::ring: angle = j * pi / n; break;
        }
        k.insert(k.end(), static_cast<std::size_t>(times),
                 4 * options.stiffness / options.mass * std::pow(std::sin(angle), 2));
    }
    std::sort(k.begin(), k.end());
    return Eigen::Map<RealVector>(k.data(), static_cast<Index>(k.size()));
}

/// Largest relative difference of the scene's spectrum from the one expected, ascending; where that
/// is 0, relative to the largest.
double worst(const Scene& scene, const RealVector& expected) {
    const Exact exact = exact_matrices(scene, scene.initial_state().x);
    const RealVector k = eigenvalues(exact.scaled(0, 1, 0, false));
    if (k.size() != expected.size()) return 1;
    const Real most = expected[k.size() - 1];
    const auto scale = (expected.array() < 1e-14L * most).select(most, expected.array());
    return static_cast<double>(((k - expected).array() / scale).abs().maxCoeff());
}

}  // namespace

TEST_CASE("chain: spectra equal the closed forms to 1e-12 relative", "[lattice]") {
    for (const ChainEnds ends : all_ends) {
        for (const Index n : {3, 4, 7, 16}) {
            const ChainOptions options{n, ends, 0.25, 300, 0.125};
            INFO("ends " << static_cast<int>(ends) << ", " << n << " masses");
            CHECK(worst(chain_scene(false, 1, options), closed_form(options)) < 1e-12);
            CHECK(worst(chain_scene(true, 1, options), closed_form(options)) < 1e4 * 0x1p-23);
            // With zero rest lengths every coordinate has the row's.
            for (const int dim : {2, 3}) {
                const Scene slack = at_zero_length(chain_scene(false, dim, options));
                CHECK(worst(slack, closed_form(options, dim)) < 1e-12);
            }
            if (ends == ChainEnds::ring) continue;
            // At rest the transverse modes are zero modes.
            RealVector expected = RealVector::Zero(3 * n);
            expected.tail(n) = closed_form(options);
            CHECK(worst(chain_scene(false, 3, options), expected) < 1e-12);
        }
    }
    // The smallest by hand.
    const auto error = [](Index masses, ChainEnds ends, const RealVector& expected) {
        return worst(chain_scene(false, 1, {masses, ends, 2, 8}), expected);
    };
    CHECK(error(1, ChainEnds::fixed_fixed, RealVector::Constant(1, 8)) < 1e-12);
    CHECK(error(1, ChainEnds::fixed_free, RealVector::Constant(1, 4)) < 1e-12);
    CHECK(error(2, ChainEnds::free_free, RealVector{{0, 8}}) < 1e-12);
}

TEST_CASE("chain: springs lie at rest, free particles come first, walls last and pinned",
          "[lattice]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const ChainEnds ends : all_ends) {
            CAPTURE(kind, static_cast<int>(ends));
            const Index walls = ends == ChainEnds::fixed_fixed  ? 2
                                : ends == ChainEnds::fixed_free ? 1
                                                                : 0;
            const Scene scene = chain_scene(kind.single, kind.dim, {7, ends, 0.5, 10, 0.25});
            REQUIRE(scene.size() == 7 + walls);
            for (Index i = 0; i < scene.size(); ++i) {
                CHECK(scene.is_pinned(i) == (i >= 7));
                CHECK(scene.mass(i) == 0.5);
            }
            CHECK(scene.force(scene.initial_state()).isZero(0));
            const auto springs = scene.springs();
            REQUIRE(scene.spring_count() == (ends == ChainEnds::ring ? 7 : 6 + walls));
            for (std::size_t s = 0; s < springs.size(); ++s) {
                const bool closing = ends == ChainEnds::ring && kind.dim == 1 && s == 6;
                CHECK(springs[s].stiffness == 10);
                CHECK_THAT(springs[s].rest_length,
                           WithinRel(closing ? 1.5 : 0.25, kind.rounding()));
            }
        }
    }
}

TEST_CASE("chain: bad input", "[lattice][bad_input]") {
    const auto refused = [](const ChainOptions& options, std::initializer_list<const char*> words) {
        return missing(message_of([&] { chain_scene(false, 2, options); }), words);
    };
    CHECK(refused({0}, {"chain", "masses is 0", "at least 1"}) == "");
    CHECK(refused({-3, ChainEnds::fixed_free}, {"chain", "masses is -3", "at least 1"}) == "");
    CHECK(refused({1, ChainEnds::free_free}, {"chain", "masses is 1", "at least 2"}) == "");
    CHECK(refused({2, ChainEnds::ring}, {"chain", "masses is 2", "at least 3"}) == "");
    CHECK(refused({4, ChainEnds::ring, 0}, {"mass", "is 0", "> 0"}) == "");
    CHECK(refused({4, ChainEnds::ring, 1, -2}, {"stiffness is -2", ">= 0"}) == "");
    CHECK(refused({4, ChainEnds::ring, 1, not_a_number}, {"stiffness is nan"}) == "");
    CHECK(refused({4, ChainEnds::fixed_fixed, 1, 1, not_a_number},
                  {"chain", "spacing", "finite"}) == "");
}

TEST_CASE("lattice: every neighbour and every diagonal of a face has one spring, at rest",
          "[lattice]") {
    for (const bool single : {false, true}) {
        for (const std::array<Index, 3> n :
             {std::array<Index, 3>{1, 1, 1}, {4, 1, 1}, {1, 3, 2}, {2, 2, 2}, {3, 5, 4}}) {
            LatticeOptions options;
            options.particles = n;
            options.diagonal = 500;
            const Scene block = single ? scene_of(taut::lattice<float>(options))
                                       : scene_of(taut::lattice<double>(options));
            REQUIRE(block.size() == n[0] * n[1] * n[2]);
            const auto x = block.initial_state().x;
            std::set<std::pair<Index, Index>> joined;
            for (const auto& spring : block.springs()) {
                joined.insert(std::minmax(spring.a, spring.b));
                const double l = (x.col(spring.b) - x.col(spring.a)).norm();
                CHECK_THAT(l, WithinAbs(spring.rest_length, 8 * block.kind().epsilon()));
                CHECK(spring.stiffness == (spring.rest_length < 0.12 ? 1000 : 500));
            }
            CHECK(static_cast<Index>(joined.size()) == block.spring_count());
            // The pairs, counted by their distance alone.
            Index near = 0, met = 0;
            for (Index a = 0; a < block.size(); ++a) {
                for (Index b = a + 1; b < block.size(); ++b) {
                    if ((x.col(b) - x.col(a)).norm() > 0.15) continue;
                    ++near;
                    met += static_cast<Index>(joined.count({a, b}));
                }
            }
            CHECK(near == block.spring_count());
            CHECK(met == near);
            for (Index i = 0; i < block.size(); ++i) CHECK_FALSE(block.is_pinned(i));
            CHECK(block.gravity().isZero(0));
        }
    }
}

TEST_CASE("lattice: equal stiffnesses make an isotropic solid of Poisson's ratio 1/4",
          "[lattice]") {
    const LatticeOptions options{{3, 3, 3}, 0.2, 700, 700, 0.01};
    const Scene block = scene_of(taut::lattice<double>(options));
    const auto x = block.initial_state().x;
    constexpr Index centre = 13;
    Random random(1);
    for (int draw = 0; draw < 20; ++draw) {
        const Eigen::Matrix3d G = random_points(random, 3, 3, -1, 1);
        const Eigen::Matrix3d strain = 1e-6 * (G + G.transpose());
        // Half of each spring belongs to either end.
        double energy = 0;
        for (const auto& spring : block.springs()) {
            if (spring.a != centre && spring.b != centre) continue;
            const Eigen::Vector3d d = x.col(spring.b) - x.col(spring.a);
            const double stretch = (d + strain * d).norm() - spring.rest_length;
            energy += 0.25 * spring.stiffness * stretch * stretch;
        }
        const double a = options.spacing;
        const double E = 5 * options.stiffness / (2 * a), nu = 0.25;
        const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
        const double density =
            lambda / 2 * strain.trace() * strain.trace() + mu * strain.squaredNorm();
        INFO("draw " << draw);
        CHECK_THAT(energy, WithinRel(density * a * a * a, 1e-4));
    }
}

TEST_CASE("lattice: bad input: options are named", "[lattice][bad_input]") {
    const auto refused = [](const char* words, auto&& change) {
        LatticeOptions options;
        change(options);
        CHECK(missing(message_of([&] { (void)taut::lattice<double>(options); }), {words}).empty());
    };
    refused("8 by 0 by 8", [](auto& o) { o.particles[1] = 0; });
    refused("spacing is 0", [](auto& o) { o.spacing = 0; });
    refused("stiffness is -1", [](auto& o) { o.stiffness = -1; });
    refused("diagonal is nan", [](auto& o) { o.diagonal = not_a_number; });
    refused("mass is 0", [](auto& o) { o.mass = 0; });
}

}  // namespace taut_test::lattice_test
