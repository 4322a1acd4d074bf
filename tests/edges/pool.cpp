// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Compiled with ThreadSanitizer: an engine's pool steps two scenes, copies of one, on two threads.
// A third edits the first of them between its frames, while the other is still being stepped; two
// more ask limits of a scene that nobody changes. The bits are those of one thread.

#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>

#include <cstdio>
#include <future>

namespace {

using Cloth = taut::SpringSystem<float, 3>;

struct Scene {
    Cloth cloth;
    Cloth::State state;
    taut::Guarded<taut::SymplecticEuler<Cloth>> guard;
    bool ok = true;

    explicit Scene(const Cloth& copied)
        : cloth(copied), state(cloth.initial_state()), guard(cloth) {
        cloth.set_external_force([](const auto& s, auto& f) { f -= 1e-3f * s.v; });
    }
    void advance() { ok = guard.advance(state, 1.0f / 60) && ok; }
    void edit(int frame) {
        cloth.remove_springs([&](taut::Index s) { return s % 97 == frame; });
        if (frame == 3) cloth.pin(200);
        if (frame == 5) cloth.set_rayleigh({0.1f, 1e-5f});
        cloth.set_stiffness(frame, 500);
    }
};

template <class Task>
std::future<void> on_a_thread(Task task) {
    return std::async(std::launch::async, task);
}

}  // namespace

int main() {
    const auto prototype = taut::hanging_cloth<float>({16, 16});
    Scene alone(prototype), alone_edited(prototype), one(prototype), edited(prototype);
    const auto limit = taut::energy_limit(prototype).certified;
    for (int frame = 0; frame < 8; ++frame) {
        alone.advance();
        alone_edited.advance();
        alone_edited.edit(frame);

        auto first = on_a_thread([&] { one.advance(); });
        on_a_thread([&] { edited.advance(); }).get();
        auto third = on_a_thread([&] { edited.edit(frame); });
        float asked[2] = {};
        auto fourth = on_a_thread([&] { asked[0] = taut::energy_limit(prototype).certified; });
        on_a_thread([&] { asked[1] = taut::energy_limit(prototype).certified; }).get();
        for (auto* thread : {&first, &third, &fourth}) thread->get();
        if (asked[0] != limit || asked[1] != limit) return 1;
    }
    const auto same = [](const Scene& a, const Scene& b) {
        return a.ok && b.ok && a.state.x == b.state.x && a.state.v == b.state.v;
    };
    if (!same(one, alone) || !same(edited, alone_edited) || edited.state.x == one.state.x) {
        std::fprintf(stderr, "on a pool's threads a scene moves otherwise\n");
        return 2;
    }
}
