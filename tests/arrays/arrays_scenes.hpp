// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <taut/arrays/arrays.hpp>
#include <vector>

#include "../support/random.hpp"
#include "../support/referee.hpp"

namespace taut_test {

/// A scene in arrays, of any scalar and dimension. Numbers are those that a float holds.
struct Net {
    bool single = false;  ///< float, else double
    int dim = 3;
    Eigen::MatrixXd x;  ///< Dim × n, m
    std::vector<double> mass;
    std::vector<int> pins;
    std::vector<std::array<int, 2>> ends;
    std::vector<double> stiffness, rest_length, damping, whole_damping;
    taut::RayleighDamping rayleigh;
    double velocity_factor = 1;

    Index size() const { return static_cast<Index>(mass.size()); }
    Index springs() const { return static_cast<Index>(ends.size()); }
    std::string text() const;
};

struct NetOptions {
    Index particles = 9;
    Index springs = 20;
    double decades = 1;          ///< masses and stiffnesses spread over
    bool zero_length = false;    ///< linear: K is the same at every pose
    bool powers_of_two = false;  ///< masses whose inverse is exact
    bool dampers = false;        ///< along the spring, of every third one
    bool whole_dampers = false;  ///< on the whole relative velocity, of every third one
    bool rayleigh = false;
};
Net random_net(Random& random, bool single, int dim, const NetOptions& options);

/// How the arrays lie in memory.
enum class Layout {
    apart,     ///< each by itself, indices int
    records,   ///< in records of particles and of springs, indices unsigned short
    inverses,  ///< as apart, with inverse masses, of which 0 pins
};

/// check_step of the arrays, as double.
taut::StepCheck<double> check_step(const Net& net, taut::Method method, double h,
                                   const taut::StepCheckOptions& options = {},
                                   Layout layout = Layout::apart, bool positions = true);

/// What a SpringSystem of the same numbers answers; whole_damping and velocity_factor it has not.
struct Answers {
    taut::StepLimit<double> any_pose, at_pose;
    std::vector<taut::SpringShare> springs;  ///< that hold most of the stiffest mode of the pose
};
Answers system_answers(const Net& net, taut::Method method, Index springs);

/// M, D, K, K⁺ of the net at its pose.
Exact exact_matrices(const Net& net);

}  // namespace taut_test
