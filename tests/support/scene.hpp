// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <string>
#include <taut/core/status.hpp>
#include <taut/conditions/method.hpp>
#include <taut/proof/step_limit.hpp>
#include <vector>

#include "random.hpp"

// Systems and steppers of any scalar, dimension and laws behind one interface, so that a property
// is one test over many of them, and compiles once. Numbers pass as double, which float and double
// keep to the bit.

namespace taut_test {

enum class Laws {
    hookean,  ///< SpringSystem<Scalar, Dim>
    strings,  ///< TensionOnly alone; two and three dimensions
    mixed,    ///< Hookean and Buckling; two and three dimensions
    any       ///< Hookean, TensionOnly, Buckling and Glue; with float in three dimensions only
};

/// Which SpringSystem a scene is.
struct Kind {
    bool single = false;  ///< float, else double
    int dim = 3;
    Laws laws = Laws::hookean;

    double epsilon() const {
        return single ? static_cast<double>(std::numeric_limits<float>::epsilon())
                      : std::numeric_limits<double>::epsilon();
    }
    /// As Tolerance of tolerance.hpp.
    double rounding() const { return 64 * epsilon(); }
    double accumulated() const { return 8192 * epsilon(); }
    std::string text() const;
};
std::ostream& operator<<(std::ostream& out, const Kind& kind);

/// All that there are; or those of some laws.
const std::vector<Kind>& all_kinds();
std::vector<Kind> kinds_of(Laws laws);

enum class LawOf { hookean, tension_only, buckling, glue };

struct AnySpring {
    Index a = 0, b = 1;
    double stiffness = 0;    ///< N/m
    double rest_length = 0;  ///< m
    double damping = 0;      ///< N·s/m, along the spring
    LawOf law = LawOf::hookean;
    double second = 0;  ///< bending of Buckling, N·m²; width of Glue, m
    double third = 0;   ///< onset of Buckling, N/m
};

/// The law's functions in long double, written by the law itself.
struct LawAt {
    long double tension, slope, energy, bound;
};
LawAt law_at(const AnySpring& spring, long double length);

struct AnyState {
    Eigen::MatrixXd x;  ///< Dim × n, m
    Eigen::MatrixXd v;  ///< Dim × n, m/s
    double time = 0;    ///< s

    friend bool operator==(const AnyState& a, const AnyState& b) {
        return a.x.cols() == b.x.cols() && a.v.cols() == b.v.cols() && a.x == b.x && a.v == b.v &&
               a.time == b.time;
    }
};

/// A limit of whatever scalar.
template <class Scalar>
taut::StepLimit<double> to_any(const taut::StepLimit<Scalar>& limit) {
    return {static_cast<double>(limit.certified),
            static_cast<double>(limit.refuted),
            limit.cause,
            static_cast<double>(limit.estimate),
            limit.growth_rate,
            static_cast<double>(limit.certified_up_to),
            limit.admitted_growth,
            limit.revision};
}

class AnyStepper {
public:
    virtual ~AnyStepper() = default;
    virtual taut::Report step(AnyState& state, double h, Index count = 1) = 0;
};

/// A SpringSystem. A stepper refers to it: the scene must outlive it, and may be changed.
class Scene {
public:
    explicit Scene(Kind kind);
    Scene(const Scene& other);
    Scene& operator=(const Scene& other);
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;
    ~Scene();

    const Kind& kind() const { return kind_; }
    int dim() const { return kind_.dim; }
    /// Rounded to the scene's scalar.
    double rounded(double number) const {
        return kind_.single ? static_cast<double>(static_cast<float>(number)) : number;
    }

    Index add_particle(const Eigen::VectorXd& x, double mass);
    Index add_spring(const AnySpring& spring);
    void remove_spring(LawOf law, Index s);
    void pin(Index i);
    void unpin(Index i);
    void set_mass(Index i, double mass);
    void set_gravity(const Eigen::VectorXd& g);
    void set_rayleigh(double mass_proportional, double stiffness_proportional);
    void set_constant_force(Index i, const Eigen::VectorXd& force);
    /// @param force  adds forces, N, to what it is given; none: takes the force away
    void set_external_force(std::function<void(const AnyState&, Eigen::MatrixXd&)> force);

    Index size() const;
    Index spring_count() const;
    bool is_pinned(Index i) const;
    double mass(Index i) const;
    Eigen::VectorXd gravity() const;
    double mass_proportional() const;
    double stiffness_proportional() const;
    std::uint64_t revision() const;
    /// Law by law.
    std::vector<AnySpring> springs() const;

    AnyState initial_state() const;
    Eigen::MatrixXd force(const AnyState& state) const;
    Eigen::MatrixXd force_ahead(const AnyState& state, double h) const;
    double kinetic_energy(const AnyState& state) const;
    double potential_energy(const AnyState& state) const;
    double energy(const AnyState& state) const;

    taut::StepLimit<double> any_pose_limit(double tightness = 0) const;
    taut::StepLimit<double> energy_limit(double tightness = 0) const;
    taut::StepLimit<double> sharp_any_pose_limit() const;
    taut::StepLimit<double> sharp_energy_limit() const;
    taut::StepLimit<double> limit(taut::Method method, const AnyState& state) const;

    /// Of the core's steppers: one that implements `method`. Laws::any has energy-stable Euler and
    /// velocity Verlet.
    std::unique_ptr<AnyStepper> stepper(taut::Method method, int threads = 1) const;

    class Base;
    /// The system, for scene_on.hpp.
    Base& base() const { return *base_; }

private:
    Kind kind_;
    std::unique_ptr<Base> base_;
};

/// What random_like (random_system.hpp) makes, to the bit.
Scene random_scene(Random& random, const Kind& kind, const RandomOptions& options = {});
/// Parameters of a law, as random_like draws them.
AnySpring draw_spring(Random& random, LawOf law);
/// The laws of a kind, in the order of its system.
std::vector<LawOf> laws_of(const Kind& kind);

/// A crumpled pose: every particle anywhere in a cube, with any velocity.
AnyState random_state(Random& random, const Scene& scene);
Eigen::VectorXd random_vector(Random& random, int dim, double low, double high);
Eigen::MatrixXd random_points(Random& random, int dim, Index n, double low, double high);

}  // namespace taut_test
