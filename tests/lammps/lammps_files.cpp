// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "lammps_files.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "../support/catch.hpp"

namespace taut_test {

void add_masses(Scene& scene) {
    for (int i = 0; i < 260; ++i) {
        scene.add_particle(Eigen::VectorXd::Zero(scene.dim()), 1 + i / 256.0);
    }
}

Eigen::Matrix3Xd Network::force() const {
    Eigen::Matrix3Xd f = gravity * mass.transpose() - v * drag.asDiagonal();
    for (const Bond& bond : bonds) {
        const Eigen::Vector3d d = x.col(bond.b) - x.col(bond.a);
        const Eigen::Vector3d pull = 2 * bond.K * (d.norm() - bond.L) * d.normalized();
        f.col(bond.a) += pull;
        f.col(bond.b) -= pull;
    }
    for (Index i = 0; i < f.cols(); ++i) {
        if (pinned[static_cast<std::size_t>(i)]) f.col(i).setZero();
    }
    return f;
}

void Network::run(int steps) {
    const Eigen::VectorXd kick = step / 2 * mass.cwiseInverse();
    Eigen::Matrix3Xd f = force();
    for (int s = 0; s < steps; ++s) {
        v += f * kick.asDiagonal();
        x += step * v;
        f = force();
        v += f * kick.asDiagonal();
    }
}

double Network::difference(const AnyState& state) const {
    const Index dim = state.x.rows();
    double largest = std::max((x.topRows(dim) - state.x).cwiseAbs().maxCoeff(),
                              (v.topRows(dim) - state.v).cwiseAbs().maxCoeff());
    for (Index d = dim; d < 3; ++d) {
        largest =
            std::max({largest, x.row(d).cwiseAbs().maxCoeff(), v.row(d).cwiseAbs().maxCoeff()});
    }
    return largest;
}

namespace {

using Row = std::vector<double>;

/// The lines of a data file, by section; those before the first section under "".
std::map<std::string, std::vector<Row>> sections(const std::string& text) {
    std::map<std::string, std::vector<Row>> found;
    std::istringstream lines(text);
    std::string line, section;
    std::getline(lines, line);  // a title
    while (std::getline(lines, line)) {
        line = line.substr(0, line.find('#'));
        std::istringstream words(line);
        Row numbers;
        for (double number = 0; words >> number;) numbers.push_back(number);
        if (!numbers.empty()) {
            found[section].push_back(numbers);
        } else if (line.find_first_not_of(' ') != line.npos) {
            section = line.substr(0, line.find_last_not_of(' ') + 1);
        }
    }
    return found;
}

/// @returns the type of each particle
std::vector<std::size_t> read_data(const std::string& text, Network& network) {
    auto data = sections(text);
    const auto& head = data[""];
    const auto count = [&](std::size_t row) { return static_cast<Index>(head.at(row).at(0)); };
    const Index n = count(0);
    network.atom_types = count(1);
    const bool bonds = head.size() == 7;
    if (bonds) network.bond_types = count(3);
    for (int d = 0; d < 3; ++d) {
        const auto& ends = head.at(static_cast<std::size_t>((bonds ? 4 : 2) + d));
        network.low[d] = ends.at(0);
        network.high[d] = ends.at(1);
    }
    network.x = network.v = Eigen::Matrix3Xd::Zero(3, n);
    network.mass = network.drag = Eigen::VectorXd::Zero(n);
    const auto place = [n](const Row& row) {
        const auto i = static_cast<Index>(row.at(0)) - 1;
        REQUIRE((i >= 0 && i < n));
        return i;
    };
    std::vector<std::size_t> type(static_cast<std::size_t>(n));
    for (const auto& row : data["Atoms"]) {
        type.at(static_cast<std::size_t>(place(row))) = static_cast<std::size_t>(row.at(2));
        network.x.col(place(row)) << row.at(3), row.at(4), row.at(5);
    }
    for (const auto& row : data["Velocities"]) {
        network.v.col(place(row)) << row.at(1), row.at(2), row.at(3);
    }
    Row type_mass(static_cast<std::size_t>(network.atom_types) + 1, 0);
    for (const auto& row : data["Masses"]) {
        type_mass.at(static_cast<std::size_t>(row.at(0))) = row.at(1);
    }
    for (Index i = 0; i < n; ++i) {
        network.mass[i] = type_mass.at(type[static_cast<std::size_t>(i)]);
    }
    for (const auto& row : data["Rmass"]) network.mass[place(row)] = row.at(1);
    const auto& coefficients = data["Bond Coeffs"];
    REQUIRE(static_cast<Index>(coefficients.size()) == network.bond_types);
    for (const auto& row : data["Bonds"]) {
        const auto& pair = coefficients.at(static_cast<std::size_t>(row.at(1)) - 1);
        network.bonds.push_back({pair.at(1), pair.at(2), static_cast<Index>(row.at(2)) - 1,
                                 static_cast<Index>(row.at(3)) - 1});
    }
    REQUIRE(static_cast<Index>(network.bonds.size()) == (bonds ? count(2) : 0));
    return type;
}

void read_script(std::string script, const std::vector<std::size_t>& type, Network& network) {
    for (std::size_t at = 0; (at = script.find("&\n", at)) != script.npos;) script.erase(at, 2);
    std::istringstream lines(script);
    const auto types = static_cast<std::size_t>(network.atom_types);
    std::size_t first_pinned = types + 1;
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
            CHECK(last == types);
        }
        if (command == "variable" && line.find("mass*v") != line.npos) {
            double factor = 0;
            words >> name >> word >> factor;
            network.drag = -factor * network.mass;
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
            Row scale(types + 1, 1);
            while (words >> word >> of >> ratio) scale.at(of) = ratio;
            for (std::size_t i = 0; i < type.size(); ++i) {
                network.drag[static_cast<Index>(i)] = gamma * scale.at(type[i]);
            }
        }
        held = held || style == "setforce";
    }
    for (const std::size_t t : type) network.pinned.push_back(t >= first_pinned);
}

}  // namespace

Network read(const Files& files) {
    Network network;
    const auto type = read_data(files.data.bytes(), network);
    read_script(files.script.bytes(), type, network);
    return network;
}

}  // namespace taut_test
