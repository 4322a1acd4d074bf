// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/io/lammps.hpp>
#include <taut/model/buckling.hpp>
#include <taut/model/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::lammps_test {

using taut::LammpsOptions;
using taut::write_lammps;
using Vector = Eigen::Vector3d;

namespace {

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
std::map<std::string, std::vector<std::vector<double>>> sections(const std::string& text) {
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

Network read(const Files& files) {
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

}  // namespace

TEMPLATE_TEST_CASE("lammps: the files hold the scene to the bit, and its motion", "[io]",
                   (Case<float, 1>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    // With masses by type and by particle; drag, gravity, and pins that move.
    for (const Index most_atom_types : {Index(256), Index(4)}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            const Files files("motion_" + std::to_string(sizeof(Scalar)) + std::to_string(Dim));
            Random random(seed);
            auto system = random_system<Scalar, Dim>(random);
            if (seed % 2 == 0) system.set_rayleigh({0.3, 0});
            if (seed == 3) system.set_gravity(Eigen::Matrix<Scalar, Dim, 1>::Zero());
            auto state = random_state(random, system);
            LammpsOptions options = files.options();
            options.most_atom_types = most_atom_types;
            const auto report = write_lammps("", system, state, options);
            REQUIRE(report);
            CHECK(report.warnings.empty());
            CHECK(report.mass_per_atom == (most_atom_types == 4));
            Network network = read(files);
            CHECK(network.atom_types == static_cast<std::size_t>(report.atom_types));
            CHECK(network.bond_types == static_cast<std::size_t>(report.bond_types));
            REQUIRE(network.x.size() == static_cast<std::size_t>(system.size()));
            CHECK(difference(network, state) == 0);
            for (Index i = 0; i < system.size(); ++i) {
                const auto at = static_cast<std::size_t>(i);
                CHECK(network.mass[at] == static_cast<double>(system.mass(i)));
                CHECK(network.pinned[at] == system.is_pinned(i));
                CHECK((network.low.array() < network.x[at].array()).all());
                CHECK((network.high.array() > network.x[at].array()).all());
            }
            REQUIRE(network.bonds.size() == static_cast<std::size_t>(system.spring_count()));
            std::size_t s = 0;
            system.visit_springs([&](const auto& spring) {
                const auto& bond = network.bonds[s++];
                CHECK(2 * bond.K == static_cast<double>(spring.parameters.stiffness));
                CHECK(bond.L == static_cast<double>(spring.rest_length));
                CHECK(bond.a == static_cast<std::size_t>(spring.a));
                CHECK(bond.b == static_cast<std::size_t>(spring.b));
            });

            const int steps = 20;
            network.run(steps);
            taut::VelocityVerlet stepper(system);
            REQUIRE(stepper.step(state, static_cast<Scalar>(report.step), steps));
            CHECK(difference(network, state) < 100 * Tolerance<Scalar>::accumulated);
        }
    }
}

TEST_CASE("lammps: a file of many blocks is whole", "[io]") {
    const Files files("blocks");
    const auto cloth = taut::hanging_cloth<double>({40, 41});
    Random random(7);
    auto state = cloth.initial_state();
    state.v = random.points<double, 3>(cloth.size(), -1, 1);
    REQUIRE(write_lammps("", cloth, state, files.options()));
    CHECK(files.data.bytes().size() > 3 * 65536);
    const Network network = read(files);
    CHECK(difference(network, state) == 0);
    REQUIRE(network.bonds.size() == static_cast<std::size_t>(cloth.spring_count()));
    std::size_t s = 0, wrong = 0;
    cloth.visit_springs([&](const auto& spring) {
        const auto& bond = network.bonds[s++];
        wrong += bond.a == static_cast<std::size_t>(spring.a) &&
                         bond.b == static_cast<std::size_t>(spring.b) &&
                         bond.L == spring.rest_length
                     ? 0
                     : 1;
    });
    CHECK(wrong == 0);
}

TEST_CASE("lammps: the step is the stated share of the certified any-pose limit", "[io]") {
    const Files files("share");
    const auto cloth = taut::hanging_cloth<double>({6, 5});
    const auto state = cloth.initial_state();
    const double certified = taut::any_pose_limit(cloth).certified;
    LammpsOptions options = files.options();
    for (const double share : {0.3, 0.95, 1.0}) {
        options.share = share;
        const auto report = write_lammps("", cloth, state, options);
        REQUIRE(report);
        CHECK(report.certified == certified);
        CHECK(report.step == share * certified);
        CHECK(read(files).step == report.step);
        CHECK(report.warnings.empty());
    }
    options.step = 1.01 * certified;
    const auto beyond = write_lammps("", cloth, state, options);
    CHECK(read(files).step == options.step);
    REQUIRE(beyond.warnings.size() == 1);
    CHECK_THAT(beyond.warnings[0], ContainsSubstring("not certified"));
    options.step = certified;
    CHECK(write_lammps("", cloth, state, options).warnings.empty());
}

TEST_CASE("lammps: the cutoff is the stretch of the longest spring, now or at rest", "[io]") {
    const Files files("cutoff");
    taut::SpringSystem<double, 3> system;
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({0, 3, 4}, 1);
    for (const double L : {1.0, 7.0}) {
        system.add_spring<taut::Hookean>({0, 1, {10}, L});
        const auto report = write_lammps("", system, system.initial_state(), files.options());
        CHECK(report.cutoff == 2 * std::max(5.0, L));
        CHECK(read(files).cutoff == report.cutoff);
    }
    LammpsOptions options = files.options();
    options.longest_stretch = 3;
    CHECK(write_lammps("", system, system.initial_state(), options).cutoff == 21);
}

TEST_CASE("lammps: springs without rest length, particles without springs, far from the origin",
          "[io]") {
    const Files files("corners");
    taut::SpringSystem<double, 2> system;
    system.add_particle({1e9, 1}, 1);
    LammpsOptions options = files.options();
    CHECK_THAT(message_of([&] { (void)write_lammps("", system, system.initial_state(), options); }),
               ContainsSubstring("certified step is inf") && ContainsSubstring("::step"));
    options.step = 0.1;
    const auto alone = write_lammps("", system, system.initial_state(), options);
    REQUIRE(alone);
    CHECK(alone.warnings.empty());
    const Network one = read(files);
    CHECK(one.bonds.empty());
    CHECK(one.low[0] < 1e9);
    CHECK(one.high[0] > 1e9);
    system.add_particle({1e9 + 1, 1}, 1);
    system.add_spring<taut::Hookean>({0, 1, {10}, 0});
    REQUIRE(write_lammps("", system, system.initial_state(), files.options()));
    const Network two = read(files);
    REQUIRE(two.bonds.size() == 1);
    CHECK(two.bonds[0].L == 0);
}

TEST_CASE("lammps: bad input: what LAMMPS lacks is refused by name, or left out with a warning",
          "[io][bad_input]") {
    using System = taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>;
    const Files files("nearest");
    System plain;
    plain.add_particle({0, 0, 0}, 1);
    plain.add_particle({1, 0, 0}, 1);
    plain.add_particle({0, 1, 0}, 1);
    plain.add_spring(0, 1, 100);
    const auto refused = [&](const char* words, auto&& change, const char* nearest) {
        CAPTURE(words);
        System system = plain;
        change(system);
        const auto state = system.initial_state();
        LammpsOptions options = files.options();
        const auto write = [&] { return write_lammps("", system, state, options); };
        CHECK(missing(message_of([&] { (void)write(); }), {words, "write_lammps"}).empty());
        CHECK(files.script.bytes().empty());  // nothing is written before all is checked
        if (nearest == nullptr) return;
        options.nearest = true;
        const auto report = write();
        REQUIRE(report.warnings.size() == 1);
        CHECK(missing(report.warnings[0], {words, nearest}).empty());
        // What is left out does not lower the limit.
        CHECK(report.certified <= taut::any_pose_limit(plain).certified);
        std::remove(files.script.path.c_str());
    };
    const auto out = "left out";
    refused(
        "set_rayleigh",
        [](System& s) {
            s.set_rayleigh({0, 1e-4});
        },
        out);
    refused(
        "set_graph_damping", [](System& s) { s.set_graph_damping(1e-4); }, out);
    refused(
        "set_wind",
        [](System& s) {
            taut::Wind<double> wind;
            wind.triangles = {{0, 1, 2}};
            wind.density = 1;
            wind.drag = 1;
            s.set_wind(wind);
        },
        out);
    refused(
        "set_particle_force",
        [](System& s) {
            s.set_particle_force([](const Vector& x, const Vector&, Index) -> Vector { return x; });
        },
        out);
    refused(
        "set_external_force", [](System& s) { s.set_external_force([](const auto&, auto&) {}); },
        out);
    refused(
        "set_constant_force",
        [](System& s) {
            s.set_constant_force(1, {0, 0, 1});
        },
        out);
    refused(
        "spring 1 has a damper of 0.5", [](System& s) { s.add_spring(0, 2, 10, 0.5); }, out);
    refused(
        "spring 1, are TensionOnly", [](System& s) { s.add_spring<taut::TensionOnly>(0, 2, {10}); },
        "harmonic bond");
    refused(
        "spring 1 is neither Hookean",
        [](System& s) {
            s.add_spring<taut::Buckling>(0, 2, {1, 1, 1});
        },
        nullptr);
}

TEST_CASE("lammps: a tension-only spring is written as a bond of its stiffness", "[io]") {
    const Files files("strings");
    taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly> system;
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({1, 0, 0}, 1);
    system.add_particle({0, 1, 0}, 1);
    system.add_spring<taut::TensionOnly>(0, 2, {30});
    system.add_spring(0, 1, 100);
    LammpsOptions options = files.options();
    options.nearest = true;
    REQUIRE(write_lammps("", system, system.initial_state(), options));
    const Network network = read(files);
    REQUIRE(network.bonds.size() == 2);  // in index order: that of the laws
    CHECK(network.bonds[0].K == 50);
    CHECK(network.bonds[1].K == 15);
    CHECK(network.bonds[1].b == 2);
}

TEST_CASE("lammps: bad input: springs that are no bond are named", "[io][bad_input]") {
    const Files files("bonds");
    taut::SpringSystem<double, 3> system;
    for (const double x : {0.0, 1.0, 2.5, 4.7}) system.add_particle({x, 0, 0}, 1);
    for (Index i = 0; i < 3; ++i) system.add_spring(i, i + 1, 100);
    const auto refusal = [&](const auto& state, const LammpsOptions& options) {
        return message_of([&] { (void)write_lammps("", system, state, options); });
    };
    auto state = system.initial_state();
    state.x.col(2) = state.x.col(1);
    CHECK(missing(refusal(state, files.options()), {"spring 1 is 0 m", "particle 1 to 2"}).empty());
    state = system.initial_state();
    state.x(0, 0) = -1.5e308;
    state.x(0, 1) = 1.5e308;
    CHECK(missing(refusal(state, files.options()), {"spring 0 is inf m"}).empty());
    state.x(0, 0) = 0;
    state.x(0, 1) = 1e308;
    CHECK(missing(refusal(state, files.options()), {"longest_stretch", "inf m"}).empty());
    // Each spring has a length of its own: so many types are memory, and refused beyond a number.
    LammpsOptions few = files.options();
    few.most_bond_types = 2;
    CHECK(missing(refusal(system.initial_state(), few),
                  {"spring 2", "bond type 3", "at most 2", "most_bond_types"})
              .empty());
    few.most_bond_types = 3;
    CHECK(write_lammps("", system, system.initial_state(), few).bond_types == 3);
}

TEST_CASE("lammps: bad input: options are named", "[io][bad_input]") {
    const Files files("options");
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    const auto refused = [&](const char* words, auto&& change) {
        LammpsOptions options = files.options();
        change(options);
        CHECK(missing(message_of(
                          [&] { (void)write_lammps("", cloth, cloth.initial_state(), options); }),
                      {words})
                  .empty());
    };
    const double nan = std::nan("");
    refused("share is 0", [](auto& o) { o.share = 0; });
    refused("share is 1.5", [](auto& o) { o.share = 1.5; });
    refused("share is nan", [&](auto& o) { o.share = nan; });
    refused("step is -1", [](auto& o) { o.step = -1; });
    refused("step is nan", [&](auto& o) { o.step = nan; });
    refused("longest_stretch is 0.5", [](auto& o) { o.longest_stretch = 0.5; });
    refused("longest_stretch is inf",
            [](auto& o) { o.longest_stretch = std::numeric_limits<double>::infinity(); });
    refused("steps is 0", [](auto& o) { o.steps = 0; });
    refused("every is 0", [](auto& o) { o.every = 0; });
    refused("most_bond_types is 0", [](auto& o) { o.most_bond_types = 0; });
    refused("most_atom_types is 1", [](auto& o) { o.most_atom_types = 1; });
    refused("name is \"\"", [](auto& o) { o.name = ""; });
    refused("name is \"a b\"", [](auto& o) { o.name = "a b"; });
    refused("name is \"../a\"", [](auto& o) { o.name = "../a"; });
    auto state = cloth.initial_state();
    state.x.resize(3, 4);
    CHECK(missing(message_of([&] { (void)write_lammps("", cloth, state); }), {"4 positions"})
              .empty());
    const taut::SpringSystem<double, 3> empty;
    CHECK(missing(message_of([&] { (void)write_lammps("", empty, empty.initial_state()); }),
                  {"no particles"})
              .empty());
}

TEST_CASE("lammps: bad input: files that cannot be written, and states that are not finite",
          "[io][bad_input]") {
    const Files files("folder");
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    auto state = cloth.initial_state();
    const auto nowhere = write_lammps("no/such/folder", cloth, state);
    CHECK_FALSE(nowhere);
    CHECK(nowhere.file.status == taut::FileStatus::not_opened);
    CHECK(nowhere.file.path == "no/such/folder/taut.data");
    CHECK(write_lammps("no/such/folder/", cloth, state).file.path == nowhere.file.path);
#if defined(__linux__)
    // A disk that is full: the data file is a link to it.
    const TemporaryFile full("full.data");
    if (std::system(("ln -s /dev/full " + full.path).c_str()) == 0) {
        LammpsOptions options;
        options.name = full.path.substr(0, full.path.size() - 5);
        const auto report = write_lammps(".", cloth, state, options);
        CHECK(report.file.status == taut::FileStatus::not_written);
        CHECK(report.file.path == "./" + full.path);
    }
#endif
    state.v(1, 4) = std::nan("");
    const auto report = write_lammps("", cloth, state, files.options());
    CHECK(report.file.status == taut::FileStatus::not_finite);
    CHECK(report.file.where == 4);
    CHECK(files.data.bytes().empty());
}

}  // namespace taut_test::lammps_test
