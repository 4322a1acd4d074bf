// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#ifdef __EMSCRIPTEN__
#include <emscripten/emscripten.h>
#define LAB_CALL EMSCRIPTEN_KEEPALIVE
#else
#define LAB_CALL
#endif

// One mass-spring scene for a page, or for a native program, to play with. Methods count as in
// taut::Method: explicit Euler, symplectic Euler, velocity Verlet, implicit Euler, BDF2,
// energy-stable Euler; 6 is Guarded, whose step is a frame. Particles count from 0. What is
// returned holds until the next call of the same function.

extern "C" {

// ---- the scene: scene.cpp ----

/// Room for the text of an OBJ file, to be written before lab_read().
LAB_CALL char* lab_text(int bytes);
/// Reads that text. @returns whether it is a mesh; if not, lab_words() says why
LAB_CALL int lab_read();
/// Makes a scene of the mesh that was read: springs as springs_from_mesh has them, pinned at its
/// top edge. lab_words() then says what is worth knowing, a sentence a line.
/// @param scale  m, of the file's unit   @param up  the file's axis that points up: 0, 1 or 2
/// @param options  the sum of: 1, vertices at one place are one (weld_vertices); 2, masses by area;
///                 4, stiffness by length (MeshOptions)
/// @returns whether there is one; if not, lab_words() says why
LAB_CALL int lab_open_mesh(double scale, int up, int options);
/// A cloth of side × side particles, flat and at rest, 1 m wide, hung by two corners. @param side ≥
/// 2
LAB_CALL void lab_open_cloth(int side);
/// A cape and a skirt on a figure of 14 capsules, which walks, runs and turns; what is pinned moves
/// with it. Its threads do not push; limits, and the pair, are those of springs that do.
LAB_CALL void lab_open_figure();
LAB_CALL const char* lab_words();

LAB_CALL int lab_size();
LAB_CALL int lab_springs();
/// The scene's measures as it was laid out; all of them double, so that a page reads one array.
struct LabShape {
    double low[3];   ///< m
    double high[3];  ///< m
    double edge;     ///< m, the mean
    double area;     ///< m², of all triangles
    double length;   ///< m, of all edges
    double pinned;   ///< particles
    double loose;    ///< particles that no chain of springs joins to a pin
};
LAB_CALL const LabShape* lab_shape();
/// Triples of particles, of lab_triangle_count() triangles.
LAB_CALL const int* lab_triangles();
LAB_CALL int lab_triangle_count();
/// Pairs of particles: the edges of the faces.
LAB_CALL const int* lab_threads();
LAB_CALL int lab_thread_count();

LAB_CALL void lab_pin(int particle, int pinned);
LAB_CALL void lab_unpin_all();
/// Pins the particles within 1 % of the height below the highest, and no others; of a scene that
/// lies flat, those at its rim towards −y.
LAB_CALL void lab_pin_top();
/// n; 1: pinned.
LAB_CALL const unsigned char* lab_pinned();

/// @param stiffness  of edges and diagonals, N/m; bending springs take a tenth, a figure's
///                   0.002
/// @param mass  of all particles together, kg
/// @param alpha  stiffness-proportional damping, s   @param drag  mass-proportional, 1/s
LAB_CALL void lab_knobs(double stiffness, double mass, double alpha, double drag);

// ---- motion: motion.cpp ----

/// Back to the pose in which the scene was laid out, at rest.
LAB_CALL void lab_reset();
/// Takes `count` ≥ 1 steps of h, s. A figure moves on with each; by energy-stable Euler and Guarded
/// the cloth touches it within the step [T39], else what is too near is moved out after each.
/// @returns a taut::Status; unless ok, the state is as it was
LAB_CALL int lab_step(int method, double h, int count);
/// s, since lab_reset.
LAB_CALL double lab_time();
/// 3 × n, m.
LAB_CALL const double* lab_positions();
/// The same, as a graphics card takes it; of a figure's cloth, horizontally from the figure.
LAB_CALL const float* lab_drawn_positions();
/// n; m: how far each particle swings from step to step, h|v⁺ − v|/4 over the last step taken. A
/// mode with the multiplier −1 has this amplitude; slow motion has next to none.
LAB_CALL const float* lab_ringing();

/// Points on the skin of the figure: how many, or 0 where there is none.
LAB_CALL int lab_figure_size();
/// Where they are, m, horizontally from the figure.
LAB_CALL const float* lab_figure_points();
/// Triples of them, of lab_figure_triangle_count() triangles.
LAB_CALL const int* lab_figure_triangles();
LAB_CALL int lab_figure_triangle_count();
/// 3; where the figure is, m.
LAB_CALL const float* lab_figure_place();
/// How far the deepest particle is below the skin, m; < 0: above it.
LAB_CALL double lab_depth();

// ---- the scene twice, without gravity, kicked along its limiting mode: pair.cpp ----

/// Room for the kick, 3 × n, m, to be written before lab_pair_start().
LAB_CALL double* lab_pair_kick();
/// @param speed  1/s, the kick's velocity over its displacement
LAB_CALL void lab_pair_start(double speed, double below, double above);
/// Takes `count` steps of symplectic Euler in both. @returns how far a particle of the one above
/// is from its place, m; infinity where a step failed
LAB_CALL double lab_pair_step(int count);
/// 3 × n, m. @param which  0: below, 1: above
LAB_CALL const float* lab_pair_positions(int which);
/// n; m: how far each particle is from its place.
LAB_CALL const float* lab_pair_moved(int which);

// ---- limits, of the scene as it was laid out, whatever its pose now: limits.cpp ----

/// The parts of the analysis, in this order; each takes its share of the time.
LAB_CALL void lab_analyse_any_pose();
LAB_CALL void lab_analyse_pose();
LAB_CALL void lab_analyse_mode();

struct LabLimits {
    double any_pose;   ///< s; certified at any pose (0: not, infinity: every step); linearised, but
                       ///< of energy-stable Euler as proved
    double certified;  ///< s; at the pose in which the scene starts (energy-stable Euler: at any)
    double refuted;    ///< s; at that pose; infinity: none is
};
/// @param method  not BDF2
LAB_CALL const LabLimits* lab_limits(int method);
/// The cause of that limit, as one sentence.
LAB_CALL const char* lab_cause(int method);

/// The limiting vibration, and the kick along it.
struct LabMode {
    double k;            ///< 1/s²
    double d;            ///< 1/s
    double k_max;        ///< 1/s²; no vibration has a larger k
    double compression;  ///< 1/s²; what compressed springs take off it at most
    double kick;         ///< m, of the particle that moves most; 0: nothing can be kicked
    double speed;        ///< 1/s, the kick's velocity over its displacement
    double steps;        ///< that show what comes of it
};
LAB_CALL const LabMode* lab_mode();
/// 3 × n, m.
LAB_CALL const double* lab_kick();
/// Springs that hold at least a thousandth of what the foremost one holds of the limiting mode's
/// energy, the foremost first: pairs of particles.
LAB_CALL const int* lab_blamed();
LAB_CALL int lab_blamed_count();
/// Their shares of the whole energy.
LAB_CALL const double* lab_shares();

/// Largest |multiplier| of a vibration at step h, s.
LAB_CALL double lab_growth(int method, double k, double d, double h);
/// The stiffness-proportional damping that makes step h, s, of explicit Euler stable is above [0],
/// or includes 0 where that is −1, and below [1]; both 0: none does.
LAB_CALL const double* lab_window(double h, double drag, double k_max, double compression);

// ---- what is recommended, for frames of 1/60 s: advice.cpp ----

/// Finds the plans that are stable, none of them timed yet.
/// @returns how many
LAB_CALL int lab_advise();
/// Times plan i for `seconds`; the least of its timings counts.
LAB_CALL void lab_time_plan(int i, double seconds);

struct LabPlan {
    double method;
    double gradients;  ///< 1: its linear systems are solved by conjugate gradients
    double substeps;   ///< of a frame
    double h;          ///< s
    double cost;       ///< s a frame, as measured here; infinity: not yet, or a step failed
};
LAB_CALL const LabPlan* lab_plan(int i);

// ---- how few particles will do: resolve.cpp ----

/// Searches for the coarsest network whose motion, from rest where the scene was laid out, is
/// estimated to stay within `goal`, a share of the scene's size, for `duration`, s. It costs up to
/// 0.3 of the scene's own run; after a minute it ends, and says so.
LAB_CALL void lab_resolve(double duration, double goal);
/// The host's: called at each of 30 samples of a run that lab_resolve() steps; both count from 0.
void lab_resolving(int run, int sample);

struct LabResolution {
    double outcome;      ///< a taut::Resolved; −1: no step of the scene is certified
    double chosen;       ///< of the levels; −1: none
    double cheaper;      ///< how many times, in spring-steps
    double fine_cost;    ///< spring-steps of the scene itself
    double search_cost;  ///< spring-steps
};
LAB_CALL const LabResolution* lab_resolution();
/// The same in a sentence.
LAB_CALL const char* lab_resolution_words();

struct LabLevel {
    double particles;
    double springs;
    double h;      ///< s, proved at any pose
    double cost;   ///< spring-steps
    double error;  ///< estimated, a share of the scene's size; infinity: not known
};
LAB_CALL const LabLevel* lab_level(int i);
LAB_CALL int lab_level_count();

// ---- the scene beside a coarser network of it, by energy-stable Euler: beside.cpp ----

/// Both from rest where the scene was laid out, for `duration`, s.
/// @param particles  of the coarser one   @param fine  0: the scene itself is too slow, and stands
LAB_CALL void lab_beside_start(int particles, double duration, int fine);
/// Takes `count` ≥ 1 steps of the scene, or of the coarser network where the scene stands, but none
/// beyond the next of 30 samples. @returns s, since the start
LAB_CALL double lab_beside_step(int count);
/// What all of those steps are.
LAB_CALL double lab_beside_steps();
/// How far both were apart at the worst sample so far, by the root mean square over particles, a
/// share of the scene's size; 0 where the scene stands; infinity where a step failed.
LAB_CALL double lab_beside_apart();
/// 3 × n, m; of the coarser network as it is lifted. @param which  0: the scene, 1: the other
LAB_CALL const float* lab_beside_positions(int which);
/// The particles of the scene that the coarser network has, the pins first.
LAB_CALL const int* lab_beside_seeds();
LAB_CALL int lab_beside_seed_count();
}
