// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A class that is not convex and does not say so is caught by an assertion; one that is convex
// never is, whatever rounding leaves of its distances.

#include <taut/contact/contact.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "../contact/curved_bodies.hpp"

namespace {

int broken = 0;

template <class Scalar>
using Vector = Eigen::Matrix<Scalar, 3, 1>;

template <class Scalar>
struct Ball {
    Scalar radius;
    taut::Surface<Scalar, 3> surface(const Vector<Scalar>& y) const {
        return taut::Sphere<Scalar, 3>({0, 0, 0}, radius).surface(y);
    }
};
/// By the farthest of its planes: outside its edges not the distance, and convex all the same.
template <class Scalar>
struct Cube {
    Scalar half;
    taut::Surface<Scalar, 3> surface(const Vector<Scalar>& y) const {
        int axis = 0;
        const Scalar most = y.cwiseAbs().maxCoeff(&axis);
        return {most - half, Vector<Scalar>::Unit(axis) * std::copysign(Scalar(1), y[axis])};
    }
};
/// A shape of curved_bodies.hpp, without its word.
template <class Scalar, class Shape>
struct Silent {
    Shape shape;
    taut::Surface<Scalar, 3> surface(const Vector<Scalar>& y) const { return shape.surface(y); }
};

/// Assertions that a net breaks which falls on a body that turns.
template <class Scalar, class Shape>
int broken_by(const Shape& shape, Scalar size) {
    taut::SpringSystem<Scalar, 3> system;
    for (int i = 0; i < 25; ++i) {
        const Vector<Scalar> at(Scalar(i % 5) - 2, Scalar(i / 5) - 2, 4);
        system.add_particle(size * at / 4, 1);
    }
    for (int i = 0; i < 25; ++i) {
        if (i % 5 < 4) system.add_spring(i, i + 1, {1000});
        if (i < 20) system.add_spring(i, i + 5, {1000});
    }
    system.set_gravity({0, 0, Scalar(-9.81)});
    taut::Contacts contacts(system);
    taut::BodyOptions options;
    options.friction = 0.5;
    contacts.add(shape, options);
    taut::EnergyStableEuler stepper(system);
    auto state = system.initial_state();
    broken = 0;
    bool touched = false;
    for (int frame = 0; frame < 200; ++frame) {
        taut::Pose<Scalar, 3> pose;
        pose.rotation =
            Eigen::AngleAxis<Scalar>(Scalar(0.005) * Scalar(frame), Vector<Scalar>::Unit(0))
                .toRotationMatrix();
        contacts.move_to(0, pose);
        if (!step_through(stepper, state, Scalar(1.0 / 600), 10, contacts)) return -1;
        touched = touched || contacts.touching() > 0;
    }
    return touched ? broken : -2;
}

template <class Scalar>
int check(const char* name) {
    int faults = 0;
    const auto expect = [&](const char* what, bool convex, int count) {
        if (count >= 0 && (count == 0) == convex) return;
        std::printf("%s, %s: %d assertions broken\n", what, name, count);
        ++faults;
    };
    for (const Scalar size : {Scalar(0.1), Scalar(1), Scalar(100)}) {
        expect("ball", true, broken_by(Ball<Scalar>{size}, size));
        expect("cube", true, broken_by(Cube<Scalar>{size}, size));
    }
    using Ring = taut_test::Torus<Scalar, 3>;
    using Rooms = taut_test::Room<Scalar, 3>;
    expect("ring", false, broken_by(Silent<Scalar, Ring>{{Scalar(0.5), Scalar(0.3)}}, Scalar(1)));
    const taut::Box<Scalar, 3> box(Vector<Scalar>(2, 2, 2));
    expect("room", false, broken_by(Silent<Scalar, Rooms>{{box}}, Scalar(1)));
    return faults;
}

}  // namespace

void engine_assert(bool holds, const char*) { broken += holds ? 0 : 1; }
void engine_fail(const char* message) {
    std::puts(message);
    std::abort();
}

int main() { return check<float>("float") + check<double>("double"); }
