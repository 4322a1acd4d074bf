// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Error against processor time of every integrator and of the peers, on three undamped scenes.
// Prints CSV. Argument: the shipped mesh.

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <taut/projective/projective.hpp>
#include <taut/recommend/recommend.hpp>
#include <taut/taut.hpp>
#include <taut/tradeoff/tradeoff.hpp>
#include <taut/scene/mesh.hpp>

#include "../../examples/common/mesh_file.hpp"
#include "../measure.hpp"
#include "../odeint.hpp"
#include "../triplet_step.hpp"
#include "cvode.hpp"

namespace {

using bench::Net;
using taut::Candidate;
using taut::Index;
using taut::LinearSolver;
using taut::Method;
using Meter = taut::TradeoffMeter<Net>;

double thread_seconds() { return 1e-3 * bench::now(bench::thread_time); }

struct Scene {
    std::string name;
    Net net;
    double duration;        // s
    double implicit_least;  // s, the smallest step of implicit rows: they cost most
};

/// A cloth, as the other benchmarks have it.
Scene cloth() {
    return {"hanging_cloth 32", taut::hanging_cloth<double>({32, 32}), 0.5, 1.0 / 960};
}

/// Forty links, held at one end and let go level: a swing of a few rad/s on springs of 6e4 rad/s.
Scene chain() {
    Scene scene{"stiff chain 40", {}, 0.5, 1.0 / 3840};
    for (int i = 0; i <= 40; ++i) {
        scene.net.add_particle({0.02 * i, 0, 0}, 0.01);
        if (i > 0) scene.net.add_spring(i - 1, i, 1e7);
    }
    scene.net.pin(0);
    scene.net.set_gravity({0, 0, -9.81});
    return scene;
}

/// The shipped skirt, held at its waist.
Scene skirt(const char* path) {
    const auto file = example::read_obj(path);
    Scene scene{"skirt.obj", taut::springs_from_mesh<double>(file.vertices, file.faces).system,
                0.25, 1.0 / 480};
    scene.net.set_gravity({0, -9.81, 0});
    for (Index i = 0; i < 64; ++i) scene.net.pin(i);
    return scene;
}

void add_taut(Meter& meter, const Scene& scene, double limit) {
    for (int halvings = 0; halvings < 5; ++halvings) {
        const double h = 0.95 * std::ldexp(limit, -halvings);
        meter.add(Candidate{Method::symplectic_euler, h});
        meter.add(Candidate{Method::velocity_verlet, h});
        if (halvings > 2) meter.add(Candidate{Method::explicit_euler, h});
    }
    for (double h = 1.0 / 30; h > 0.99 * scene.implicit_least; h /= 2) {
        meter.add(Candidate{Method::implicit_euler, h});
        meter.add(Candidate{Method::implicit_euler, h, LinearSolver::conjugate_gradient, 1e-6});
        meter.add(Candidate{Method::bdf2, h});
        meter.add(Candidate{Method::bdf2, h, LinearSolver::conjugate_gradient, 1e-6});
        taut::ProjectiveDynamics<Net> projective(scene.net);
        meter.add("projective_dynamics, 10 iterations", h,
                  [&](Net::State& state, double step, Index count) {
                      return static_cast<bool>(projective.step(state, step, count));
                  });
    }
}

void add_peers(Meter& meter, const Scene& scene, double limit) {
    for (double h = 1.0 / 30; h > 0.99 * scene.implicit_least; h /= 2) {
        meter.add("tutorial implicit step", h, [&](Net::State& state, double step, Index count) {
            bench::TripletStep triplets(scene.net, step, true);
            bool alive = true;
            for (Index i = 0; alive && i < count; ++i) alive = triplets(state);
            return alive;
        });
    }
    for (int halvings = 0; halvings < 4; ++halvings) {
        bench::OdeintSymplectic odeint(scene.net);
        meter.add("odeint symplectic_euler", 0.95 * std::ldexp(limit, -halvings),
                  [&](Net::State& state, double step, Index count) {
                      odeint.step(step, count);
                      state = odeint.state();
                      return true;
                  });
    }
    const double sample = scene.duration / 60;
    const auto by_tolerance = [&](const char* name, double tolerance, auto& peer) {
        char text[64];
        std::snprintf(text, sizeof text, "%s/%.0e", name, tolerance);
        meter.add(text, sample, [&](Net::State& state, double span, Index) {
            const bool alive = static_cast<bool>(peer.advance(span));
            state = peer.state();
            return alive;
        });
    };
    for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
        bench::OdeintDopri5 dopri5(scene.net, tolerance);
        by_tolerance("odeint runge_kutta_dopri5", tolerance, dopri5);
        bench::Cvode adams(scene.net, CV_ADAMS, tolerance);
        by_tolerance("CVODE Adams", tolerance, adams);
        bench::Cvode differences(scene.net, CV_BDF, tolerance);
        by_tolerance("CVODE BDF", tolerance, differences);
    }
}

void rows(const Scene& scene) {
    taut::TradeoffOptions options;
    options.clock = &thread_seconds;
    Meter meter(scene.net, scene.net.initial_state(), scene.duration, options);
    const double limit = taut::any_pose_limit(scene.net).certified;
    add_taut(meter, scene, limit);
    add_peers(meter, scene, limit);
    const auto result = meter.finish();
    for (const auto& point : result.points) {
        const auto slash = point.name.find('/');  // a peer's own tolerance takes the place of h
        std::printf("%s,\"%s\",%s,%.6g,%lld,%.6g,%.6g,%.6g,%d,%.3g,%d\n", scene.name.c_str(),
                    point.name.substr(0, slash).c_str(),
                    slash == std::string::npos ? "" : point.name.substr(slash + 1).c_str(),
                    point.candidate.h, static_cast<long long>(point.steps), 1e3 * point.cost,
                    point.position_error, point.energy_drift, point.finished ? 1 : 0,
                    result.reference_error, result.reference_settled ? 1 : 0);
    }
    std::fflush(stdout);
}

}  // namespace

/// Arguments: the mesh; nothing for the chain and the cloth alone.
int main(int argc, char** argv) try {
    const std::optional<Scene> garment =
        argc > 1 ? std::optional<Scene>(skirt(argv[1])) : std::nullopt;
    std::printf(
        "scene,integrator,tolerance,h_s,steps,cpu_ms_per_s,position_error,energy_drift,finished,"
        "reference_error,reference_settled\n");
    rows(chain());
    rows(cloth());
    if (garment) rows(*garment);
} catch (const std::exception& error) {
    std::fprintf(stderr, "work_precision: %s\n", error.what());
    return 1;
}
