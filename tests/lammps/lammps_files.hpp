// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <taut/lammps/lammps.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/temporary_file.hpp"

// What write_lammps has written, read back.

namespace taut_test {

using taut::LammpsOptions;
using taut::write_lammps;
using Vector = Eigen::Vector3d;

/// Adds particles without springs, of more masses than LAMMPS is given types.
template <class System>
void add_masses(System& system) {
    using Scalar = typename System::Scalar;
    for (int i = 0; i < 260; ++i) {
        system.add_particle(System::Vector::Zero(), 1 + Scalar(i) / 256);
    }
}

/// The two files of a scene in the working directory, removed at the end of the test.
struct Files {
    explicit Files(const std::string& name) : data(name + ".data"), script(name + ".in") {
        stem = data.path.substr(0, data.path.size() - 5);
    }
    LammpsOptions options() const {
        LammpsOptions options;
        options.name = stem;
        return options;
    }
    TemporaryFile data;
    TemporaryFile script;
    std::string stem;
};

/// What LAMMPS reads, after its manual (read_data, bond_style harmonic, fix gravity, fix viscous,
/// fix addforce, fix setforce) and not after the writer: particles, bonds and what acts on them.
struct Network {
    struct Bond {
        double K, L;
        std::size_t a, b;
    };
    std::vector<Vector> x, v;
    std::vector<double> mass;
    std::vector<double> drag;  // γ, kg/s
    std::vector<bool> pinned;
    std::vector<Bond> bonds;
    Vector gravity = Vector::Zero();
    double step = 0;
    double cutoff = 0;
    std::size_t atom_types = 0, bond_types = 0;
    Vector low, high;

    std::vector<Vector> force() const {
        std::vector<Vector> f(x.size());
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = mass[i] * gravity - drag[i] * v[i];
        for (const Bond& bond : bonds) {
            const Vector d = x[bond.b] - x[bond.a];
            const Vector pull = 2 * bond.K * (d.norm() - bond.L) * d.normalized();
            f[bond.a] += pull;
            f[bond.b] -= pull;
        }
        for (std::size_t i = 0; i < f.size(); ++i) {
            if (pinned[i]) f[i].setZero();
        }
        return f;
    }
    /// Velocity Verlet as fix nve does it.
    void run(int steps) {
        auto f = force();
        for (int s = 0; s < steps; ++s) {
            for (std::size_t i = 0; i < x.size(); ++i) {
                v[i] += step / 2 / mass[i] * f[i];
                x[i] += step * v[i];
            }
            f = force();
            for (std::size_t i = 0; i < x.size(); ++i) v[i] += step / 2 / mass[i] * f[i];
        }
    }
};

/// The lines of a data file, by section; those before the first section under "".
inline std::map<std::string, std::vector<std::vector<double>>> sections(const std::string& text) {
    std::map<std::string, std::vector<std::vector<double>>> found;
    std::istringstream lines(text);
    std::string line, section;
    std::getline(lines, line);  // a title
    while (std::getline(lines, line)) {
        line = line.substr(0, line.find('#'));
        std::istringstream words(line);
        std::vector<double> numbers;
        for (double number = 0; words >> number;) numbers.push_back(number);
        if (!numbers.empty()) {
            found[section].push_back(numbers);
        } else if (line.find_first_not_of(' ') != line.npos) {
            section = line.substr(0, line.find_last_not_of(' ') + 1);
        }
    }
    return found;
}

inline Network read(const Files& files) {
    Network network;
    const auto data = sections(files.data.bytes());
    const auto rows = [&](const char* name) {
        const auto at = data.find(name);
        return at == data.end() ? std::vector<std::vector<double>>() : at->second;
    };
    const auto head = rows("");
    const auto count = [&](std::size_t row) {
        return static_cast<std::size_t>(head.at(row).at(0));
    };
    const std::size_t n = count(0);
    network.atom_types = count(1);
    const bool bonds = head.size() == 7;
    if (bonds) network.bond_types = count(3);
    for (std::size_t d = 0; d < 3; ++d) {
        network.low[static_cast<Index>(d)] = head.at((bonds ? 4 : 2) + d).at(0);
        network.high[static_cast<Index>(d)] = head.at((bonds ? 4 : 2) + d).at(1);
    }
    network.x.resize(n);
    network.v.assign(n, Vector::Zero());
    network.mass.resize(n);
    network.drag.assign(n, 0);
    std::vector<std::size_t> type(n);
    const auto id = [](const std::vector<double>& row) {
        return static_cast<std::size_t>(row.at(0)) - 1;
    };
    for (const auto& row : rows("Atoms")) {
        type.at(id(row)) = static_cast<std::size_t>(row.at(2));
        network.x.at(id(row)) = {row.at(3), row.at(4), row.at(5)};
    }
    for (const auto& row : rows("Velocities")) {
        network.v.at(id(row)) = {row.at(1), row.at(2), row.at(3)};
    }
    std::vector<double> type_mass(network.atom_types + 1, 0);
    for (const auto& row : rows("Masses")) type_mass.at(id(row) + 1) = row.at(1);
    for (std::size_t i = 0; i < n; ++i) network.mass[i] = type_mass.at(type[i]);
    for (const auto& row : rows("Rmass")) network.mass.at(id(row)) = row.at(1);
    const auto coefficients = rows("Bond Coeffs");
    REQUIRE(coefficients.size() == network.bond_types);
    for (const auto& row : rows("Bonds")) {
        const auto& pair = coefficients.at(static_cast<std::size_t>(row.at(1)) - 1);
        network.bonds.push_back({pair.at(1), pair.at(2), static_cast<std::size_t>(row.at(2)) - 1,
                                 static_cast<std::size_t>(row.at(3)) - 1});
    }
    REQUIRE(network.bonds.size() == (bonds ? count(2) : 0));

    std::string script = files.script.bytes();
    for (std::size_t at = 0; (at = script.find("&\n", at)) != script.npos;) script.erase(at, 2);
    std::istringstream lines(script);
    std::size_t first_pinned = network.atom_types + 1;
    bool held = false;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string command, name, all, style, word;
        words >> command;
        if (command == "timestep") words >> network.step;
        if (command == "comm_modify") words >> word >> network.cutoff;
        if (command == "group") {
            char colon = ':';
            std::size_t last = 0;
            words >> name >> word >> first_pinned >> colon >> last;
            CHECK(last == network.atom_types);
        }
        if (command == "variable" && line.find("mass*v") != line.npos) {
            double factor = 0;
            words >> name >> word >> factor;
            for (std::size_t i = 0; i < n; ++i) network.drag[i] = -factor * network.mass[i];
        }
        if (command != "fix") continue;
        CHECK_FALSE(held);  // what comes later would move the pins
        words >> name >> all >> style;
        if (style == "gravity") {
            double magnitude = 0;
            words >> magnitude >> word;
            words >> network.gravity[0] >> network.gravity[1] >> network.gravity[2];
            network.gravity *= magnitude / network.gravity.norm();
        }
        if (style == "viscous") {
            double gamma = 0, ratio = 0;
            std::size_t of = 0;
            words >> gamma;
            std::vector<double> scale(network.atom_types + 1, 1);
            while (words >> word >> of >> ratio) scale.at(of) = ratio;
            for (std::size_t i = 0; i < n; ++i) network.drag[i] = gamma * scale.at(type[i]);
        }
        held = held || style == "setforce";
    }
    for (const std::size_t t : type) network.pinned.push_back(t >= first_pinned);
    return network;
}

template <class State>
double difference(const Network& network, const State& state) {
    double largest = 0;
    for (std::size_t i = 0; i < network.x.size(); ++i) {
        for (Index d = 0; d < 3; ++d) {
            const auto at = static_cast<Index>(i);
            const double x = d < State::Dim ? static_cast<double>(state.x(d, at)) : 0;
            const double v = d < State::Dim ? static_cast<double>(state.v(d, at)) : 0;
            largest =
                std::max({largest, std::abs(network.x[i][d] - x), std::abs(network.v[i][d] - v)});
        }
    }
    return largest;
}

}  // namespace taut_test
