// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Two builds of the library in one program: an inline function may have one definition, so the
// second build has names of its own.
#ifdef TAUT_SAME_BITS
#define taut taut_same_bits
#define Eigen Eigen_same_bits
#endif

#include "steps.hpp"

#include <cstdlib>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/proof/any_pose.hpp>
#include <taut/scene/cloth.hpp>

namespace {

template <class Scalar>
class StepsOf : public bench::Steps {
public:
    using System = taut::SpringSystem<Scalar, 3>;

    explicit StepsOf(const taut::ClothOptions& options)
        : cloth_(taut::hanging_cloth<Scalar>(options)) {}

    void take(int count) override {
        if (!stepper_.step(state_, h_, count)) std::abort();
    }
    double springs() const override { return static_cast<double>(cloth_.spring_count()); }

private:
    System cloth_;
    taut::SymplecticEuler<System> stepper_{cloth_};
    typename System::State state_ = cloth_.initial_state();
    Scalar h_ = Scalar(0.5) * taut::any_pose_limit(cloth_).certified;
};

template <class Scalar>
std::unique_ptr<bench::Steps> steps(int side) {
    return std::make_unique<StepsOf<Scalar>>(taut::ClothOptions{side, side});
}

}  // namespace

#ifdef TAUT_SAME_BITS
template <class Scalar>
std::unique_ptr<bench::Steps> bench::same_bits_steps(int side) {
    return steps<Scalar>(side);
}
template std::unique_ptr<bench::Steps> bench::same_bits_steps<float>(int);
template std::unique_ptr<bench::Steps> bench::same_bits_steps<double>(int);
#else
template <class Scalar>
std::unique_ptr<bench::Steps> bench::plain_steps(int side) {
    return steps<Scalar>(side);
}
template std::unique_ptr<bench::Steps> bench::plain_steps<float>(int);
template std::unique_ptr<bench::Steps> bench::plain_steps<double>(int);
#endif
