// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <taut/core/types.hpp>

namespace taut_test {

using taut::Index;

/// Uniform random numbers with the same bits on every platform: std::mt19937 is specified to the
/// bit, the distributions of the standard library are not.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}

    /// In [low, high), rounded to float, so that a float and a double system get the same numbers.
    double uniform(double low, double high) {
        const double unit = static_cast<double>(engine_()) / 4294967296.0;
        return static_cast<double>(static_cast<float>(low + (high - low) * unit));
    }
    /// One of 0 … n − 1.
    Index below(Index n) { return static_cast<Index>(engine_() % static_cast<std::uint32_t>(n)); }

    template <class Scalar, int Rows>
    Eigen::Matrix<Scalar, Rows, 1> vector(double low, double high) {
        Eigen::Matrix<Scalar, Rows, 1> v;
        for (int i = 0; i < Rows; ++i) v[i] = static_cast<Scalar>(uniform(low, high));
        return v;
    }
    template <class Scalar, int Dim>
    taut::Points<Scalar, Dim> points(Index n, double low, double high) {
        taut::Points<Scalar, Dim> p(Dim, n);
        for (Index i = 0; i < n; ++i) p.col(i) = vector<Scalar, Dim>(low, high);
        return p;
    }

private:
    std::mt19937 engine_;
};

/// Spread evenly over orders of magnitude.
inline double log_uniform(Random& random, double low, double high) {
    return std::exp2(random.uniform(std::log2(low), std::log2(high)));
}

/// Of random_like (random_system.hpp) and random_scene (scene.hpp).
struct RandomOptions {
    Index particles = 8;
    Index springs = 14;    ///< of each law
    Index pinned = 2;      ///< the first ones
    bool dampers = false;  ///< axial, on every second spring
    bool rayleigh = false;
    bool gravity = true;
};

}  // namespace taut_test
