// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "scene_on.hpp"

namespace taut_test {

namespace {

template <class Scalar, template <class, int> class Of>
std::unique_ptr<Scene::Base> of_dim(int dim) {
    if (dim == 2) return std::make_unique<SceneOn<Of<Scalar, 2>>>();
    if (dim == 3) return std::make_unique<SceneOn<Of<Scalar, 3>>>();
    throw std::logic_error("no such scene");
}
template <class Scalar>
std::unique_ptr<Scene::Base> make_base(const Kind& kind) {
    switch (kind.laws) {
        case Laws::hookean:
            if (kind.dim == 1) return std::make_unique<SceneOn<Plain<Scalar, 1>>>();
            return of_dim<Scalar, Plain>(kind.dim);
        case Laws::strings: return of_dim<Scalar, Strings>(kind.dim);
        case Laws::mixed: return of_dim<Scalar, Mixed>(kind.dim);
        case Laws::any: break;
    }
    if constexpr (std::is_same_v<Scalar, float>) {
        if (kind.dim == 3) return std::make_unique<SceneOn<AnyLaw<float, 3>>>();
        throw std::logic_error("no such scene");
    } else {
        if (kind.dim == 1) return std::make_unique<SceneOn<AnyLaw<double, 1>>>();
        return of_dim<double, AnyLaw>(kind.dim);
    }
}

}  // namespace

std::string Kind::text() const {
    const char* names[] = {"Hookean", "strings", "Hookean and Buckling", "all laws"};
    return std::string(single ? "float " : "double ") + std::to_string(dim) + "d, " +
           names[static_cast<int>(laws)];
}
std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.text(); }

std::vector<Kind> kinds_of(Laws laws) {
    std::vector<Kind> kinds;
    for (const bool single : {false, true}) {
        for (int dim = 1; dim <= 3; ++dim) {
            if (dim == 1 && (laws == Laws::strings || laws == Laws::mixed)) continue;
            if (laws == Laws::any && single && dim < 3) continue;
            kinds.push_back({single, dim, laws});
        }
    }
    return kinds;
}
const std::vector<Kind>& all_kinds() {
    static const std::vector<Kind> all = [] {
        std::vector<Kind> kinds;
        for (const Laws laws : {Laws::hookean, Laws::strings, Laws::mixed, Laws::any}) {
            const auto more = kinds_of(laws);
            kinds.insert(kinds.end(), more.begin(), more.end());
        }
        return kinds;
    }();
    return all;
}

LawAt law_at(const AnySpring& spring, long double l) {
    const long double L = spring.rest_length;
    const auto of = [&](auto law) {
        using Law = decltype(law);
        const auto p = exact_parameters<Law>(spring);
        return LawAt{Law::tension(p, L, l), Law::tension_slope(p, L, l), Law::energy(p, L, l),
                     Law::stiffness_bound(p, L)};
    };
    switch (spring.law) {
        case LawOf::hookean: return of(taut::Hookean{});
        case LawOf::tension_only: return of(TensionOnly{});
        case LawOf::buckling: return of(Buckling{});
        case LawOf::glue: break;
    }
    return of(Glue{});
}

Scene::Scene(Kind kind)
    : kind_(kind), base_(kind.single ? make_base<float>(kind) : make_base<double>(kind)) {}
Scene::Scene(const Scene& other) : kind_(other.kind_), base_(other.base_->copy()) {}
Scene& Scene::operator=(const Scene& other) {
    kind_ = other.kind_;
    base_ = other.base_->copy();
    return *this;
}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Index Scene::add_particle(const Eigen::VectorXd& x, double mass) {
    return base_->add_particle(x, mass);
}
Index Scene::add_spring(const AnySpring& spring) { return base_->add_spring(spring); }
void Scene::remove_spring(LawOf law, Index s) { base_->remove_spring(law, s); }
void Scene::pin(Index i) { base_->set_pinned(i, true); }
void Scene::unpin(Index i) { base_->set_pinned(i, false); }
void Scene::set_mass(Index i, double mass) { base_->set_mass(i, mass); }
void Scene::set_gravity(const Eigen::VectorXd& g) { base_->set_gravity(g); }
void Scene::set_rayleigh(double d0, double alpha) { base_->set_rayleigh({d0, alpha}); }
void Scene::set_constant_force(Index i, const Eigen::VectorXd& force) {
    base_->set_constant_force(i, force);
}
void Scene::set_external_force(std::function<void(const AnyState&, Eigen::MatrixXd&)> force) {
    base_->set_external_force(std::move(force));
}
Index Scene::size() const { return base_->size(); }
Index Scene::spring_count() const { return base_->spring_count(); }
bool Scene::is_pinned(Index i) const { return base_->is_pinned(i); }
double Scene::mass(Index i) const { return base_->mass(i); }
Eigen::VectorXd Scene::gravity() const { return base_->gravity(); }
double Scene::mass_proportional() const { return base_->rayleigh().mass_proportional; }
double Scene::stiffness_proportional() const { return base_->rayleigh().stiffness_proportional; }
std::uint64_t Scene::revision() const { return base_->revision(); }
std::vector<AnySpring> Scene::springs() const { return base_->springs(); }
AnyState Scene::initial_state() const { return base_->initial_state(); }
Eigen::MatrixXd Scene::force(const AnyState& state) const { return base_->force(state, 0); }
Eigen::MatrixXd Scene::force_ahead(const AnyState& state, double h) const {
    return base_->force(state, h);
}
double Scene::kinetic_energy(const AnyState& state) const { return base_->kinetic_energy(state); }
double Scene::potential_energy(const AnyState& state) const {
    return base_->potential_energy(state);
}
double Scene::energy(const AnyState& state) const { return base_->energy(state); }
taut::StepLimit<double> Scene::limit(taut::Method method, const AnyState& state) const {
    return base_->limit(method, state);
}
std::unique_ptr<AnyStepper> Scene::stepper(taut::Method method, int threads) const {
    return base_->stepper(method, threads);
}

std::vector<LawOf> laws_of(const Kind& kind) {
    switch (kind.laws) {
        case Laws::hookean: return {LawOf::hookean};
        case Laws::strings: return {LawOf::tension_only};
        case Laws::mixed: return {LawOf::hookean, LawOf::buckling};
        case Laws::any: break;
    }
    return {LawOf::hookean, LawOf::tension_only, LawOf::buckling, LawOf::glue};
}

AnySpring draw_spring(Random& random, LawOf law) {
    AnySpring spring;
    spring.law = law;
    spring.stiffness = random.uniform(20, 200);
    if (law == LawOf::buckling) {
        spring.second = random.uniform(0.01, 2);
        spring.third = random.uniform(20, 400);
    }
    if (law == LawOf::glue) spring.second = random.uniform(0.3, 1);
    return spring;
}

Eigen::VectorXd random_vector(Random& random, int dim, double low, double high) {
    Eigen::VectorXd v(dim);
    for (int i = 0; i < dim; ++i) v[i] = random.uniform(low, high);
    return v;
}
Eigen::MatrixXd random_points(Random& random, int dim, Index n, double low, double high) {
    Eigen::MatrixXd p(dim, n);
    for (Index i = 0; i < n; ++i) p.col(i) = random_vector(random, dim, low, high);
    return p;
}

Scene random_scene(Random& random, const Kind& kind, const RandomOptions& options) {
    Scene scene(kind);
    for (Index i = 0; i < options.particles; ++i) {
        const auto place = random_vector(random, kind.dim, -1, 1);
        scene.add_particle(place, random.uniform(0.5, 2));
    }
    for (const LawOf law : laws_of(kind)) {
        for (Index s = 0; s < options.springs; ++s) {
            const Index a = random.below(options.particles);
            const Index b = (a + 1 + random.below(options.particles - 1)) % options.particles;
            auto spring = draw_spring(random, law);
            spring.a = a;
            spring.b = b;
            spring.rest_length = random.uniform(0.2, 1.4);
            const double damping = random.uniform(0.1, 1);
            if (options.dampers && s % 2 == 1) spring.damping = damping;
            scene.add_spring(spring);
        }
    }
    for (Index i = 0; i < options.pinned; ++i) scene.pin(i);
    if (options.gravity) scene.set_gravity(random_vector(random, kind.dim, -10, 10));
    if (options.rayleigh) scene.set_rayleigh(0.25, 0.0078125);
    return scene;
}

AnyState random_state(Random& random, const Scene& scene) {
    auto state = scene.initial_state();
    state.x = random_points(random, scene.dim(), scene.size(), -1, 1);
    state.v = random_points(random, scene.dim(), scene.size(), -1, 1);
    return state;
}

}  // namespace taut_test
