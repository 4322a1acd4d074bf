// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "arrays_scenes.hpp"

#include <algorithm>
#include <taut/network/spring_system.hpp>
#include <taut/proof/bracket.hpp>

#include "../support/scene.hpp"

namespace taut_test {
namespace {

/// Of float or double and of a dimension, whichever the net has.
template <class Action>
auto visit(const Net& net, const Action& action) {
    const auto in = [&](auto scalar) {
        using Scalar = decltype(scalar);
        if (net.dim == 1) return action(scalar, std::integral_constant<int, 1>{});
        if (net.dim == 2) return action(Scalar{}, std::integral_constant<int, 2>{});
        return action(Scalar{}, std::integral_constant<int, 3>{});
    };
    return net.single ? in(float{}) : in(double{});
}

template <class Scalar>
std::vector<Scalar> cast(const std::vector<double>& numbers) {
    std::vector<Scalar> cast;
    for (const double number : numbers) cast.push_back(static_cast<Scalar>(number));
    return cast;
}

template <class Scalar>
taut::StepAnswer<double> in_double(const taut::StepAnswer<Scalar>& answer) {
    return {answer.safe, answer.substeps, to_any(answer.limit), answer.to_blame};
}
template <class Scalar>
taut::StepCheck<double> in_double(const taut::StepCheck<Scalar>& check) {
    taut::StepCheck<double> all;
    const taut::StepAnswer<Scalar>& any_pose = check;
    static_cast<taut::StepAnswer<double>&>(all) = in_double(any_pose);
    if (check.at_pose) all.at_pose = in_double(*check.at_pose);
    return all;
}

template <class Scalar, int Dim, class Int>
taut::SpringArrays<Scalar, Dim, Int> sized(const Net& net) {
    taut::SpringArrays<Scalar, Dim, Int> arrays;
    arrays.particles = net.size();
    arrays.springs = net.springs();
    arrays.rayleigh = net.rayleigh;
    arrays.velocity_factor = static_cast<Scalar>(net.velocity_factor);
    return arrays;
}

template <class Scalar, int Dim>
taut::StepCheck<double> check_apart(const Net& net, taut::Method method, double h,
                                    const taut::StepCheckOptions& options, bool inverses,
                                    bool positions) {
    auto arrays = sized<Scalar, Dim, int>(net);
    const taut::Points<Scalar, Dim> x = net.x.cast<Scalar>();
    auto mass = cast<Scalar>(net.mass);
    const auto k = cast<Scalar>(net.stiffness), L = cast<Scalar>(net.rest_length),
               c = cast<Scalar>(net.damping), whole = cast<Scalar>(net.whole_damping);
    if (inverses) {
        for (Scalar& m : mass) m = 1 / m;
        for (const int i : net.pins) mass[std::size_t(i)] = 0;
        arrays.inverse_mass = mass;
    } else {
        arrays.mass = mass;
        arrays.pinned = net.pins;
        arrays.pins = static_cast<Index>(net.pins.size());
    }
    if (positions) arrays.position = x;
    if (!net.ends.empty()) arrays.ends = {net.ends[0].data(), sizeof net.ends[0]};
    arrays.stiffness = k;
    arrays.rest_length = L;
    // One number may stand for all.
    if (std::all_of(L.begin(), L.end(), [](Scalar one) { return one == 0; })) {
        arrays.rest_length = 0;
    }
    const bool same = std::all_of(c.begin(), c.end(), [&](Scalar one) { return one == c[0]; });
    if (same && !c.empty()) arrays.damping = c[0];
    if (!same) arrays.damping = c;
    arrays.whole_damping = whole;
    return in_double(taut::check_step(arrays, method, h, options));
}

template <class Scalar, int Dim>
taut::StepCheck<double> check_records(const Net& net, taut::Method method, double h,
                                      const taut::StepCheckOptions& options, bool positions) {
    using Int = unsigned short;
    struct Particle {
        char name;
        Scalar x[Dim];
        Scalar mass;
    };
    struct Link {
        Scalar k, L;
        Int ends[2];
        Scalar c, whole;
    };
    std::vector<Particle> particles(net.mass.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
        for (int d = 0; d < Dim; ++d) particles[i].x[d] = Scalar(net.x(d, Index(i)));
        particles[i].mass = static_cast<Scalar>(net.mass[i]);
    }
    std::vector<Link> links(net.ends.size());
    for (std::size_t s = 0; s < links.size(); ++s) {
        links[s] = {static_cast<Scalar>(net.stiffness[s]),
                    static_cast<Scalar>(net.rest_length[s]),
                    {static_cast<Int>(net.ends[s][0]), static_cast<Int>(net.ends[s][1])},
                    static_cast<Scalar>(net.damping[s]),
                    static_cast<Scalar>(net.whole_damping[s])};
    }
    std::vector<std::array<Int, 3>> pins;  // the second of three
    for (const int i : net.pins) pins.push_back({0, static_cast<Int>(i), 0});
    auto arrays = sized<Scalar, Dim, Int>(net);
    arrays.mass = {&particles[0].mass, sizeof(Particle)};
    if (positions) arrays.position = {particles[0].x, sizeof(Particle)};
    if (!pins.empty()) arrays.pinned = {&pins[0][1], sizeof pins[0]};
    arrays.pins = static_cast<Index>(pins.size());
    arrays.ends = {links[0].ends, sizeof(Link)};
    arrays.stiffness = {&links[0].k, sizeof(Link)};
    arrays.rest_length = {&links[0].L, sizeof(Link)};
    arrays.damping = {&links[0].c, sizeof(Link)};
    arrays.whole_damping = {&links[0].whole, sizeof(Link)};
    return in_double(taut::check_step(arrays, method, h, options));
}

}  // namespace

std::string Net::text() const {
    return std::string(single ? "float" : "double") + ", " + std::to_string(dim) + "-D, " +
           std::to_string(size()) + " particles, " + std::to_string(springs()) + " springs";
}

Net random_net(Random& random, bool single, int dim, const NetOptions& options) {
    const auto as_float = [](double number) {
        return static_cast<double>(static_cast<float>(number));
    };
    const double spread = std::pow(10, options.decades);
    Net net;
    net.single = single;
    net.dim = dim;
    net.x.resize(dim, options.particles);
    for (Index i = 0; i < options.particles; ++i) {
        for (int d = 0; d < dim; ++d) net.x(d, i) = random.uniform(-1, 1);
        const double mass = log_uniform(random, 1, spread);
        net.mass.push_back(options.powers_of_two ? std::exp2(std::floor(std::log2(mass)))
                                                 : as_float(mass));
    }
    for (Index s = 0; s < options.springs; ++s) {
        const Index a = random.below(options.particles);
        const Index b = (a + 1 + random.below(options.particles - 1)) % options.particles;
        net.ends.push_back({static_cast<int>(a), static_cast<int>(b)});
        net.stiffness.push_back(as_float(log_uniform(random, 100, 100 * spread)));
        net.rest_length.push_back(options.zero_length ? 0 : random.uniform(0.2, 1.4));
        const double c = random.uniform(0.5, 20), whole = random.uniform(0.5, 20);
        net.damping.push_back(options.dampers && s % 3 == 1 ? c : 0);
        net.whole_damping.push_back(options.whole_dampers && s % 3 != 0 ? whole : 0);
    }
    for (Index i = 0; i < options.particles; ++i) {
        if (random.below(5) == 0) net.pins.push_back(static_cast<int>(i));
    }
    if (options.rayleigh) net.rayleigh = {0.25, 0.0078125};
    return net;
}

taut::StepCheck<double> check_step(const Net& net, taut::Method method, double h,
                                   const taut::StepCheckOptions& options, Layout layout,
                                   bool positions) {
    return visit(net, [&](auto scalar, auto dim) {
        using Scalar = decltype(scalar);
        if (layout == Layout::records) {
            return check_records<Scalar, dim>(net, method, h, options, positions);
        }
        return check_apart<Scalar, dim>(net, method, h, options, layout == Layout::inverses,
                                        positions);
    });
}

Answers system_answers(const Net& net, taut::Method method, Index springs) {
    return visit(net, [&](auto scalar, auto dim) {
        using Scalar = decltype(scalar);
        taut::SpringSystem<Scalar, dim> system;
        for (Index i = 0; i < net.size(); ++i) {
            const Eigen::Matrix<Scalar, dim, 1> x = net.x.col(i).cast<Scalar>();
            system.add_particle(x, static_cast<Scalar>(net.mass[std::size_t(i)]));
        }
        for (std::size_t s = 0; s < net.ends.size(); ++s) {
            system.add_spring(
                taut::Spring<Scalar, taut::Hookean>{net.ends[s][0],
                                                    net.ends[s][1],
                                                    {static_cast<Scalar>(net.stiffness[s])},
                                                    static_cast<Scalar>(net.rest_length[s]),
                                                    static_cast<Scalar>(net.damping[s])});
        }
        for (const int i : net.pins) system.pin(i);
        system.set_rayleigh(net.rayleigh);
        const taut::Stability<Scalar> stability(system, system.initial_state());
        Answers answers{to_any(taut::any_pose_limit(system, method)), {}, {}};
        if (method == taut::Method::energy_stable_euler) return answers;  // nothing at a pose
        answers.at_pose = to_any(stability.max_step(method));
        answers.springs = taut::limiting_springs(stability, springs);
        return answers;
    });
}

Exact exact_matrices(const Net& net) {
    std::vector<Index> place(net.mass.size(), 0);
    for (const int i : net.pins) place[std::size_t(i)] = -1;
    Index free = 0;
    for (Index& p : place) p = p < 0 ? -1 : free++;
    Exact e = Exact::zero(net.dim * free);
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] >= 0) e.mass.segment(net.dim * place[i], net.dim).setConstant(net.mass[i]);
    }
    for (std::size_t s = 0; s < net.ends.size(); ++s) {
        const auto [a, b] = net.ends[s];
        const RealVector dx = net.x.col(b).cast<Real>() - net.x.col(a).cast<Real>();
        const Real l = dx.norm(), k = net.stiffness[s], L = net.rest_length[s];
        const Real across = net.dim == 1 ? 0 : k * (l - L) / l;
        const Index at_a = place[std::size_t(a)], at_b = place[std::size_t(b)];
        e.add(at_a, at_b, {dx, k, k, across, net.damping[s]});
        const Real c = net.whole_damping[s];
        for (int d = 0; d < net.dim; ++d) {
            const Index row = net.dim * at_a + d, column = net.dim * at_b + d;
            if (at_a >= 0) e.D(row, row) += c;
            if (at_b >= 0) e.D(column, column) += c;
            if (at_a >= 0 && at_b >= 0) e.D(row, column) -= c, e.D(column, row) -= c;
        }
    }
    e.add_rayleigh(net.rayleigh.mass_proportional, net.rayleigh.stiffness_proportional);
    return e;
}

}  // namespace taut_test
