// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "../support/temporary_file.hpp"
#include "lammps_scenes.hpp"

// What write_lammps has written, read back.

namespace taut_test {

/// Adds particles without springs, of more masses than LAMMPS is given types.
void add_masses(Scene& scene);

/// The files of a scene in the working directory, removed at the end of the test.
struct Files {
    explicit Files(const std::string& name)
        : stem(temporary_prefix() + name), data(name + ".data"), script(name + ".in") {}
    LammpsOptions options() const {
        LammpsOptions options;
        options.name = stem;
        return options;
    }
    std::string stem;
    TemporaryFile data;
    TemporaryFile script;
};

/// What LAMMPS reads, after its manual (read_data, bond_style harmonic, fix gravity, fix viscous,
/// fix addforce, fix setforce) and not after the writer: particles, bonds and what acts on them.
struct Network {
    struct Bond {
        double K, L;
        Index a, b;
    };
    Eigen::Matrix3Xd x, v;
    Eigen::VectorXd mass;
    Eigen::VectorXd drag;  // γ, kg/s
    std::vector<bool> pinned;
    std::vector<Bond> bonds;
    Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
    double step = 0;
    double cutoff = 0;
    Index atom_types = 0, bond_types = 0;
    Eigen::Vector3d low, high;

    Eigen::Matrix3Xd force() const;
    /// Velocity Verlet as fix nve does it.
    void run(int steps);
    /// From a state, the largest of x and v.
    double difference(const AnyState& state) const;
};

Network read(const Files& files);

}  // namespace taut_test
