// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

template <class Scalar, int Dim, class... Laws>
Index SpringSystem<Scalar, Dim, Laws...>::add_particle(const Vector& position, Scalar mass) {
    if (!detail::finite_one_by_one(position.data(), position.size())) {
        fail("SpringSystem::add_particle: the position of particle ", size(), " is not finite");
    }
    require_mass("add_particle", size(), mass);
    for (int d = 0; d < Dim; ++d) position_.push_back(position[d]);
    mass_.push_back(mass);
    inverse_mass_.push_back(Scalar(1) / mass);
    ++revision_;
    ++topology_revision_;
    return size() - 1;
}

template <class Scalar, int Dim, class... Laws>
Index SpringSystem<Scalar, Dim, Laws...>::add_spring(Index a, Index b, Scalar stiffness,
                                                     Scalar damping) {
    return add_spring<Hookean>(a, b, {stiffness}, damping);
}

template <class Scalar, int Dim, class... Laws>
template <class Law>
Index SpringSystem<Scalar, Dim, Laws...>::add_spring(
    Index a, Index b, const network_detail::usable_parameters<Law, Scalar>& parameters,
    Scalar damping) {
    require_particle("add_spring", "a", a);
    require_particle("add_spring", "b", b);
    // The same expression as SpringSet::tangent, so that the spring is unstressed to the last bit.
    Vector dx;
    bool apart = false;
    for (int d = 0; d < Dim; ++d) {
        dx[d] = position_[Dim * b + d] - position_[Dim * a + d];
        apart = apart || dx[d] != 0;
    }
    const Scalar length = apart ? spring_length(dx) : Scalar(0);
    return add_spring(Spring<Scalar, Law>{a, b, parameters, length, damping});
}

template <class Scalar, int Dim, class... Laws>
template <class Law>
Index SpringSystem<Scalar, Dim, Laws...>::add_spring(const Spring<Scalar, Law>& spring) {
    static_assert(has_law<Law>,
                  "taut::SpringSystem::add_spring: the law is not one of the system's Laws");
    require_particle("add_spring", "a", spring.a);
    require_particle("add_spring", "b", spring.b);
    if (spring.a == spring.b) {
        fail("SpringSystem::add_spring: a and b are both ", spring.a,
             "; a spring joins two different particles");
    }
    char where[96];
    std::snprintf(where, sizeof where, "SpringSystem::add_spring(%lld, %lld)",
                  static_cast<long long>(spring.a), static_cast<long long>(spring.b));
    require_non_negative(where, "rest_length", spring.rest_length);
    require_non_negative(where, "damping", spring.damping);
    spring.parameters.require_valid(where);
#ifndef NDEBUG
    network_detail::check_law<network_detail::usable_law<Law, Scalar>>(spring.parameters,
                                                                       spring.rest_length);
#endif
    auto& set = std::get<network_detail::SetOf<Scalar, Law>>(sets_);
    set.add({spring.a, spring.b, spring.parameters, spring.rest_length, spring.damping});
    ++revision_;
    ++topology_revision_;
    return set.size() - 1;
}

/// The springs of a law, of which s must be one.
template <class Scalar, int Dim, class... Laws>
template <class Law>
network_detail::SetOf<Scalar, Law>& SpringSystem<Scalar, Dim, Laws...>::set_with(
    const char* function, Index s) {
    static_assert(has_law<Law>, "taut::SpringSystem: the law is not one of the system's Laws");
    auto& set = std::get<network_detail::SetOf<Scalar, Law>>(sets_);
    if (s < 0 || s >= set.size()) {
        fail("SpringSystem::", function, ": s is ", s, "; the law has ", set.size(),
             " springs, numbered from 0");
    }
    return set;
}

template <class Scalar, int Dim, class... Laws>
template <class Law>
void SpringSystem<Scalar, Dim, Laws...>::remove_spring(Index s) {
    set_with<Law>("remove_spring", s).remove(static_cast<std::size_t>(s));
    ++revision_;
    ++topology_revision_;
}

template <class Scalar, int Dim, class... Laws>
template <class Law, class Predicate>
Index SpringSystem<Scalar, Dim, Laws...>::remove_springs(Predicate&& goes) {
    auto& set = std::get<network_detail::SetOf<Scalar, Law>>(sets_);
    const Index removed = set.remove_if(goes);
    if (removed > 0) {
        ++revision_;
        ++topology_revision_;
    }
    return removed;
}

template <class Scalar, int Dim, class... Laws>
template <class Law>
void SpringSystem<Scalar, Dim, Laws...>::set_parameters(
    Index s, const network_detail::usable_parameters<Law, Scalar>& parameters) {
    auto& set = set_with<Law>("set_parameters", s);
    char where[96];
    std::snprintf(where, sizeof where, "SpringSystem::set_parameters(%lld)",
                  static_cast<long long>(s));
    parameters.require_valid(where);
    set.parameters[static_cast<std::size_t>(s)] = parameters;
    ++revision_;
    ++parameter_revision_;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::set_pinned(Index i, bool pinned) {
    require_particle(pinned ? "pin" : "unpin", "i", i);
    if (is_pinned(i) == pinned) return;
    inverse_mass_[i] = pinned ? Scalar(0) : Scalar(1) / mass_[i];
    ++revision_;
    ++topology_revision_;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::set_mass(Index i, Scalar mass) {
    require_particle("set_mass", "i", i);
    require_mass("set_mass", i, mass);
    mass_[i] = mass;
    if (!is_pinned(i)) inverse_mass_[i] = Scalar(1) / mass;
    ++revision_;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::set_gravity(const Vector& gravity) {
    if (!detail::finite_one_by_one(gravity.data(), gravity.size()))
        fail("SpringSystem::set_gravity: gravity is not finite");
    gravity_ = gravity;
    ++force_revision_;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::set_constant_force(Index i, const Vector& force) {
    require_particle("set_constant_force", "i", i);
    if (!detail::finite_one_by_one(force.data(), force.size())) {
        fail("SpringSystem::set_constant_force: the force on particle ", i, " is not finite");
    }
    auto& constant = external_.constant;
    const Index before = constant.cols();
    if (i >= before) {
        constant.conservativeResize(Dim, size());
        constant.rightCols(size() - before).setZero();
    }
    external_.constants += (force.isZero(0) ? 0 : 1) - (constant.col(i).isZero(0) ? 0 : 1);
    constant.col(i) = force;
    if (external_.constants == 0) constant.resize(Dim, 0);
    ++force_revision_;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::set_rayleigh(const RayleighDamping& rayleigh) {
    constexpr const char* where = "SpringSystem::set_rayleigh";
    require_held<Scalar>(where, "mass_proportional", rayleigh.mass_proportional);
    require_held<Scalar>(where, "stiffness_proportional", rayleigh.stiffness_proportional);
    rayleigh_ = rayleigh;
    ++revision_;
}

template <class Scalar, int Dim, class... Laws>
Index SpringSystem<Scalar, Dim, Laws...>::spring_count() const {
    Index count = 0;
    for_each_set([&](const auto& set) { count += set.size(); });
    return count;
}

template <class Scalar, int Dim, class... Laws>
Index SpringSystem<Scalar, Dim, Laws...>::pinned_count() const {
    return (inverse_mass().array() == Scalar(0)).count();
}

template <class Scalar, int Dim, class... Laws>
auto SpringSystem<Scalar, Dim, Laws...>::initial_state() const -> State {
    State state{State::zero(size()), State::zero(size()), Scalar(0)};
    std::copy_n(position_.data(), position_.size(), state.x.data());
    return state;
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::require_particle(const char* function,
                                                          const char* argument, Index i) const {
    if (i < 0 || i >= size()) {
        fail("SpringSystem::", function, ": ", argument, " is ", i, "; the system has ", size(),
             " particles, numbered from 0");
    }
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::require_mass(const char* function, Index i,
                                                      Scalar mass) const {
    // 1/mass must be finite too, or a step would divide by zero.
    if (!(mass > 0) || !detail::is_finite(mass) || !detail::is_finite(Scalar(1) / mass)) {
        fail("SpringSystem::", function, ": the mass of particle ", i, " is ", mass,
             "; it must be finite and > 0 (pin a particle to fix it)");
    }
}

}  // namespace taut
