// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/lattice/chain.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/decompositions.hpp"
#include "../support/tolerance.hpp"
#include "../support/zero_rest_length.hpp"

namespace taut_test::chain_test {

using taut::ChainEnds;
using taut::ChainOptions;
using taut::Index;

namespace {

const double pi = std::acos(-1.0);

/// Theory's closed forms, ascending, in 1/s².
std::vector<double> closed_form(const ChainOptions& options) {
    const auto n = static_cast<int>(options.masses);
    std::vector<double> k;
    for (int j = 0; j < n; ++j) {
        double angle = 0;
        switch (options.ends) {
            case ChainEnds::fixed_fixed: angle = (j + 1) * pi / (2 * (n + 1)); break;
            case ChainEnds::fixed_free: angle = (2 * j + 1) * pi / (2 * (2 * n + 1)); break;
            case ChainEnds::free_free: angle = j * pi / (2 * n); break;
            case ChainEnds::ring: angle = j * pi / n; break;
        }
        k.push_back(4 * options.stiffness / options.mass * std::pow(std::sin(angle), 2));
    }
    std::sort(k.begin(), k.end());
    return k;
}

/// Largest relative difference; where the closed form is 0, relative to the largest.
double worst(const Eigen::VectorXd& measured, const std::vector<double>& expected) {
    if (measured.size() != static_cast<Index>(expected.size())) return 1;
    double error = 0;
    for (std::size_t j = 0; j < expected.size(); ++j) {
        const bool zero = expected[j] < 1e-14 * expected.back();
        const double scale = zero ? expected.back() : expected[j];
        error = std::max(error, std::abs(measured[static_cast<Index>(j)] - expected[j]) / scale);
    }
    return error;
}

template <class Scalar, int Dim>
Eigen::VectorXd measured(const ChainOptions& options) {
    const auto system = taut::chain<Scalar, Dim>(options);
    return stiffness_eigenvalues(taut::linearize(system, system.initial_state()));
}

const auto all_ends = {ChainEnds::fixed_fixed, ChainEnds::fixed_free, ChainEnds::free_free,
                       ChainEnds::ring};

}  // namespace

TEST_CASE("chain: spectra equal the closed forms to 1e-12 relative", "[scene]") {
    for (const ChainEnds ends : all_ends) {
        for (const Index n : {3, 4, 7, 16}) {
            const ChainOptions options{n, ends, 0.25, 300, 0.125};
            INFO("ends " << static_cast<int>(ends) << ", " << n << " masses");
            CHECK(worst(measured<double, 1>(options), closed_form(options)) < 1e-12);
            CHECK(worst(measured<float, 1>(options), closed_form(options)) <
                  1e4 * Tolerance<float>::epsilon);
        }
    }
}

TEST_CASE("chain: the smallest chains by hand", "[scene]") {
    CHECK(worst(measured<double, 1>({1, ChainEnds::fixed_fixed, 2, 8}), {8}) < 1e-12);
    CHECK(worst(measured<double, 1>({1, ChainEnds::fixed_free, 2, 8}), {4}) < 1e-12);
    CHECK(worst(measured<double, 1>({2, ChainEnds::free_free, 2, 8}), {0, 8}) < 1e-12);
}

TEST_CASE("chain: at rest in more dimensions the transverse modes are zero modes", "[scene]") {
    for (const ChainEnds ends :
         {ChainEnds::fixed_fixed, ChainEnds::fixed_free, ChainEnds::free_free}) {
        const ChainOptions options{6, ends, 2, 50, 0.5};
        auto expected = closed_form(options);
        expected.insert(expected.begin(), 12, 0.0);
        CHECK(worst(measured<double, 3>(options), expected) < 1e-12);
    }
}

TEST_CASE("chain: with zero rest lengths every coordinate has the row's spectrum", "[scene]") {
    for (const ChainEnds ends : all_ends) {
        const ChainOptions options{5, ends, 2, 50, 0.5};
        const auto slack = at_zero_rest_length(taut::chain<double, 2>(options));
        std::vector<double> expected;
        for (const double k : closed_form(options)) expected.insert(expected.end(), 2, k);
        const auto k = stiffness_eigenvalues(taut::linearize(slack, slack.initial_state()));
        CHECK(worst(k, expected) < 1e-12);
    }
}

TEMPLATE_TEST_CASE("chain: springs lie at rest, free particles come first, walls last and pinned",
                   "[scene]", (Case<float, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    for (const ChainEnds ends : all_ends) {
        const Index walls = ends == ChainEnds::fixed_fixed  ? 2
                            : ends == ChainEnds::fixed_free ? 1
                                                            : 0;
        const Index springs = ends == ChainEnds::ring ? 7 : 6 + walls;
        const auto system = taut::chain<Scalar, TestType::Dim>({7, ends, 0.5, 10, 0.25});
        CHECK(system.size() == 7 + walls);
        CHECK(system.pinned_count() == walls);
        CHECK(system.spring_count() == springs);
        for (Index i = 0; i < system.size(); ++i) {
            CHECK(system.is_pinned(i) == (i >= 7));
            CHECK(system.mass(i) == Scalar(0.5));
        }
        const auto state = system.initial_state();
        taut::Points<Scalar, TestType::Dim> f;
        system.force(state, f);
        CHECK(f.isZero(0));
        const auto& set = system.springs();
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const bool closing = ends == ChainEnds::ring && TestType::Dim == 1 && s == 6;
            CHECK_THAT(
                static_cast<double>(set.rest_length[s]),
                Catch::Matchers::WithinRel(closing ? 1.5 : 0.25, Tolerance<Scalar>::rounding));
        }
    }
}

TEST_CASE("chain: bad input", "[scene][bad_input]") {
    const auto refused = [](const ChainOptions& options, std::initializer_list<const char*> words) {
        return missing(message_of([&] { static_cast<void>(taut::chain<double, 2>(options)); }),
                       words);
    };
    CHECK(refused({0}, {"chain", "masses is 0", "at least 1"}) == "");
    CHECK(refused({-3, ChainEnds::fixed_free}, {"chain", "masses is -3", "at least 1"}) == "");
    CHECK(refused({1, ChainEnds::free_free}, {"chain", "masses is 1", "at least 2"}) == "");
    CHECK(refused({2, ChainEnds::ring}, {"chain", "masses is 2", "at least 3"}) == "");
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused({4, ChainEnds::ring, 0}, {"mass", "is 0", "> 0"}) == "");
    CHECK(refused({4, ChainEnds::ring, 1, -2}, {"stiffness is -2", ">= 0"}) == "");
    CHECK(refused({4, ChainEnds::ring, 1, not_a_number}, {"stiffness is nan"}) == "");
    CHECK(refused({4, ChainEnds::fixed_fixed, 1, 1, not_a_number},
                  {"chain", "spacing", "finite"}) == "");
}

}  // namespace taut_test::chain_test
