// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Law: needs `template <class Scalar> Parameters`
// EXPECT: taut::Law: Parameters needs `void require_valid(const char* where) const`
// EXPECT: taut::Law: Parameters needs `template <class Other> Parameters<Other> cast() const`
// EXPECT: taut::Law: needs `static constexpr bool convex`
// EXPECT: taut::Law: needs `static Scalar energy(
// EXPECT: taut::Law: needs `static Scalar stiffness_bound(
// EXPECT: taut::Law: needs `static Scalar tension(
// EXPECT: taut::Law: needs `static Scalar tension_slope(
// EXPECT: taut::Law: slope_range must be
// ERRORS: 9
// Each law lacks one member, and is told so in one sentence, whatever is done with it.

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

class NoParameters : public taut::Hookean {
    using Hookean::Parameters;  // private: as good as absent
};

struct Unchecked : taut::Hookean {
    template <class Scalar>
    struct Parameters : Hookean::Parameters<Scalar> {
        Parameters(Scalar k = 0) : Hookean::Parameters<Scalar>{k} {}
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(this->stiffness)};
        }

    private:
        using Hookean::Parameters<Scalar>::require_valid;
    };
};

struct OnePrecision : taut::Hookean {
    template <class Scalar>
    struct Parameters {
        Scalar stiffness;
        void require_valid(const char*) const {}
    };
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L);
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar) {
        return p.stiffness;
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L) * (l - L) / 2;
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }
};

class NoConvex : public taut::Hookean {
    using Hookean::convex;  // private: as good as absent
};

class NoEnergy : public taut::Hookean {
    using Hookean::energy;
};

class NoBound : public taut::Hookean {
    using Hookean::stiffness_bound;
};

class NoTension : public taut::Hookean {
    using Hookean::tension;
};

class NoSlope : public taut::Hookean {
    using Hookean::tension_slope;
};

/// Its slope_range gives one number, so that the slopes between two lengths would not be asked for.
struct Kinked : taut::Hookean {
    template <class Scalar>
    static Scalar slope_range(const Parameters<Scalar>& p, Scalar, Scalar, Scalar) {
        return p.stiffness;
    }
};

template <class Law>
void use(taut::SpringSystem<double, 3, Law>& system) {
    system.template add_spring<Law>(0, 1, {10});
    auto state = system.initial_state();
    system.energy(state);
    taut::linearize(system, state);
    taut::SymplecticEuler stepper(system);
    if (!stepper.step(state, 0.01)) return;
}

template void use(taut::SpringSystem<double, 3, NoParameters>&);
template void use(taut::SpringSystem<double, 3, Unchecked>&);
template void use(taut::SpringSystem<double, 3, OnePrecision>&);
template void use(taut::SpringSystem<double, 3, NoConvex>&);
template void use(taut::SpringSystem<double, 3, NoEnergy>&);
template void use(taut::SpringSystem<double, 3, NoBound>&);
template void use(taut::SpringSystem<double, 3, NoTension>&);
template void use(taut::SpringSystem<double, 3, NoSlope>&);
template void use(taut::SpringSystem<double, 3, Kinked>&);
