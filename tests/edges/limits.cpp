// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Limits of three scenes, bit by bit: certified and refuted in turn. With a file of what this
// printed on another machine: they are the same but for rounding. A refuted step comes from a
// vector, and a certified one at a pose begins with a cosine: a product and a sum may be rounded at
// once, sums run in another order, and each C library has its own cosine. Wherever a bound begins,
// it is proved.

#include <taut/proof/bracket.hpp>
#include <taut/taut.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace {

std::vector<double> numbers;

template <class Scalar>
bool add(const taut::StepLimit<Scalar>& limit) {
    numbers.push_back(double(limit.certified));
    numbers.push_back(double(limit.refuted));
    return 0 < limit.certified && limit.certified < limit.refuted;
}

template <class System>
bool add_limits(const System& system) {
    using Scalar = typename System::Scalar;
    const taut::Stability<Scalar> stability(system, system.initial_state());
    return add(taut::bracket(stability, taut::Method::symplectic_euler)) &&
           add(taut::any_pose_bracket(system)) && add(taut::energy_bracket(system));
}

}  // namespace

int main(int count, char** arguments) {
    auto cloth = taut::hanging_cloth<double>({24, 24});
    if (!add_limits(cloth) || !add_limits(taut::hanging_cloth<float>({24, 24}))) return 1;
    cloth.set_rayleigh({0.1, 1e-5});
    cloth.unpin(0);
    for (taut::Index i = 0; i < 500; i += 3) {
        cloth.add_spring(i, 575 - i, 50.0 + double(i), 0.01);
    }
    if (!add_limits(cloth)) return 1;

    for (const double number : numbers) std::printf("%a\n", number);
    if (count < 2) return 0;
    std::ifstream file(arguments[1]);
    std::string line;
    for (const double number : numbers) {
        if (!std::getline(file, line)) return 2;
        const double native = std::strtod(line.c_str(), nullptr);
        const double apart = std::abs(number - native) / native;
        if (apart > 0) std::printf("%a here, %s there: %g apart\n", number, line.c_str(), apart);
        if (!(apart <= 1e-11)) return 3;
    }
    return std::getline(file, line) ? 4 : 0;
}
