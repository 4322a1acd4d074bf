// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// After its first call an explicit step allocates nothing, nor does a guarded frame after its
// second, with 10 000 contacts or without: neither by operator new nor by Eigen.

#define EIGEN_RUNTIME_NO_MALLOC
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <vector>

namespace {
long allocations = 0;
bool eigen_allocated = false;
}  // namespace

// Eigen asserts on every allocation while none is allowed.
#define eigen_assert(condition) ((condition) ? void() : void(eigen_allocated = true))
#include <taut/contact/self_contact.hpp>
#include <taut/contact/skin.hpp>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>

#include "steppers.hpp"

// Not inline: GCC would take the pair for a mismatch of new and free.
EIGEN_DONT_INLINE void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    std::abort();
}
EIGEN_DONT_INLINE void* operator new[](std::size_t size) { return operator new(size); }
EIGEN_DONT_INLINE void operator delete(void* memory) noexcept { std::free(memory); }
EIGEN_DONT_INLINE void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
EIGEN_DONT_INLINE void operator delete[](void* memory) noexcept { std::free(memory); }
EIGEN_DONT_INLINE void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

template <class Stepper, class System>
bool allocates(const char* name, const System& system) {
    constexpr double h = 1e-5;
    auto state = system.initial_state();
    Stepper stepper(system);
    const auto step = [&](taut::Index count) { return bool(stepper.step(state, h, count)); };
    // An engine's array of float4, stepped in the precision of the system.
    std::vector<float> x(static_cast<std::size_t>(4 * system.size())), v = x;
    taut::StateView<float, System::Dim> view(x.data(), v.data(), system.size(), 4);
    view.copy_from(state);
    const auto on_view = [&] { return bool(stepper.step(view, h, 3)); };
    if (!step(2) || !on_view()) return true;
    const long before = allocations;
    eigen_allocated = false;
    Eigen::internal::set_is_malloc_allowed(false);
    const bool stepped = step(1) && step(130) && on_view();
    Eigen::internal::set_is_malloc_allowed(true);
    const bool found = allocations != before || eigen_allocated || !stepped;
    if (found) std::fprintf(stderr, "%s allocates, or does not step\n", name);
    return found;
}

template <class System>
bool any_allocates(const System& system) {
    bool any = false;
    edges::each_explicit<System>([&](auto kind) {
        any = allocates<typename decltype(kind)::Type>(kind.name, system) || any;
    });
    return any;
}

/// A cloth thrown so hard that frames are trimmed and taken again; as an engine would, in float.
bool guarded_frames_allocate() {
    auto cloth = taut::hanging_cloth<float>({20, 20});
    const auto start = cloth.initial_state();
    auto state = start;
    std::vector<float> x(3 * 400), v = x;
    taut::StateView<float, 3> view(x.data(), v.data(), 400);
    taut::Guarded guard(cloth);
    const auto thrown_until_again = [&] {
        for (int frame = 0; frame < 600; ++frame) {
            if (frame % 30 == 0) {
                state = start;
                state.v.row(2).tail(380).setConstant(200);
            }
            const auto report = guard.advance(state, 1.0f / 60);
            if (!report) return false;
            if (report.again == 0) continue;
            view.copy_from(state);
            return bool(guard.advance(view, 1.0f / 60));
        }
        return false;
    };
    if (!thrown_until_again()) return true;
    const long before = allocations;
    eigen_allocated = false;
    Eigen::internal::set_is_malloc_allowed(false);
    const bool thrown = thrown_until_again();
    Eigen::internal::set_is_malloc_allowed(true);
    const bool found = allocations != before || eigen_allocated || !thrown;
    if (found) std::fprintf(stderr, "Guarded allocates, or is never thrown hard enough\n");
    return found;
}

/// A cloth of 10 000 particles lies on a floor that rises, some of it on a ball, on a skin that
/// rises.
bool contacts_allocate() {
    auto cloth = taut::hanging_cloth<float>({100, 100});
    for (taut::Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
    cloth.set_gravity({0, 0, -10});
    auto state = cloth.initial_state();
    for (taut::Index i = 0; i < cloth.size(); ++i)
        state.x.col(i) = Eigen::Vector3f(float(i % 100) / 99, float(i / 100) / 99, -0.001f);
    taut::Guarded guard(cloth);
    taut::Contacts contacts(cloth);
    taut::BodyOptions options;
    options.friction = 0.5;
    taut::Pose<float, 3> pose;
    contacts.add(taut::HalfSpace<float, 3>({0, 0, 0}, {0, 0, 1}), options);
    contacts.add(taut::Sphere<float, 3>({0.5f, 0.5f, -0.2f}, 0.2f), options);
    taut::Points<float, 3> places = state.x, normals = 0 * places;
    normals.row(2).setOnes();
    taut::Skin skin(contacts, places, normals);
    for (taut::Index i = 0; i < cloth.size(); i += 3) skin.limit(i, {0.02f, 0.003f});
    const auto frames = [&](int count) {
        for (int frame = 0; frame < count; ++frame) {
            pose.position[2] += 0.001f;
            places.row(2).array() += 0.001f;
            skin.move_to(places, normals);
            for (taut::Index body = 0; body < 2; ++body) contacts.move_to(body, pose);
            if (!guard.advance(state, 1.0f / 240, contacts)) return false;
        }
        return true;
    };
    if (!frames(20)) return true;
    const long before = allocations;
    eigen_allocated = false;
    Eigen::internal::set_is_malloc_allowed(false);
    const bool ran = frames(5);
    Eigen::internal::set_is_malloc_allowed(true);
    const bool found = allocations != before || eigen_allocated || !ran || !(contacts.work() > 0);
    if (found) std::fprintf(stderr, "Contacts allocate, or do nothing\n");
    return found;
}

/// A cloth that falls on the other half of itself, and on a ball.
bool self_contact_allocates() {
    auto cloth = taut::hanging_cloth<float>({30, 20});
    cloth.set_rayleigh({1, 0});
    auto start = cloth.initial_state();
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        if (start.x(1, i) > 0.5f) {
            start.x(2, i) = 0.1f;
            start.x(1, i) = 1 - start.x(1, i);
        }
    }
    auto state = start;
    taut::Contacts bodies(cloth);
    bodies.add(taut::Sphere<float, 3>({0.5f, 0.3f, -0.35f}, 0.3f));
    taut::SelfContact contact(cloth, bodies);
    taut::Guarded guard(cloth);
    taut::EnergyStableEuler stepper(cloth);
    const float h = 0.8f * taut::energy_limit(cloth).certified;
    taut::Index touched = 0, most = 0;
    const auto fall = [&] {
        for (const bool guarded : {true, false}) {
            state = start;
            for (int frame = 0; frame < 120; ++frame) {
                if (guarded && !guard.advance(state, 1.0f / 60, contact)) return false;
                if (!guarded && !taut::step_through(stepper, state, h, 60, contact)) return false;
                most = std::max(most, contact.touching());
                touched += bodies.touching() > 0;
            }
        }
        return touched > 0 && most > 0;
    };
    if (!fall()) return true;
    const long before = allocations;
    eigen_allocated = false;
    Eigen::internal::set_is_malloc_allowed(false);
    const bool fell = fall();
    Eigen::internal::set_is_malloc_allowed(true);
    const bool found = allocations != before || eigen_allocated || !fell;
    if (found) {
        std::fprintf(stderr, "SelfContact allocates %ld times, or nothing touches\n",
                     allocations - before);
    }
    return found;
}

}  // namespace

int main() {
    if (guarded_frames_allocate() || contacts_allocate() || self_contact_allocates()) return 1;
    auto cloth = taut::hanging_cloth<double>({60, 60});
    if (any_allocates(cloth)) return 1;
    cloth.set_rayleigh({0.1, 1e-6});
    cloth.add_spring(5, 3003, 10, 0.1);
    if (any_allocates(cloth)) return 1;
    cloth.set_external_force([](const auto&, auto& f) { f.array() += 0.001; });
    return any_allocates(cloth) ? 1 : 0;
}
