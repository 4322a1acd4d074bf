#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Draws the figures of docs/tradeoff.md from the CSV files of the tradeoff programs, and prints the
numbers of the recommendation grid.

usage: plot_tradeoff.py FOLDER_WITH_CSV FOLDER_FOR_SVG      (Debian: python3-matplotlib)
"""

import csv
import math
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

plt.rcParams.update({
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "savefig.dpi": 250,  # of what is rasterised
    "svg.hashsalt": "taut",  # the same bytes from the same numbers
})

# Okabe and Ito's colours, which the colour-blind tell apart; line style and marker say it again.
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, RED, PINK = (
    "#000000", "#e69f00", "#56b4e9", "#009e73", "#b8a800", "#0072b2", "#d55e00", "#cc79a7")

INTEGRATORS = {  # name in the CSV: (label, colour, marker, line)
    "symplectic_euler": ("symplectic Euler", BLUE, "o", "-"),
    "velocity_verlet": ("velocity Verlet", GREEN, "s", "-"),
    "explicit_euler": ("explicit Euler", BLACK, "x", "-"),
    "implicit_euler by sparse Cholesky": ("implicit Euler, Cholesky", RED, "^", "-"),
    "implicit_euler by conjugate gradients": ("implicit Euler, CG", RED, "v", "-"),
    "bdf2 by sparse Cholesky": ("BDF2, Cholesky", PINK, "^", "-"),
    "bdf2 by conjugate gradients": ("BDF2, CG", PINK, "v", "-"),
    "projective_dynamics, 10 iterations": ("projective dynamics", YELLOW, "D", "-"),
    "tutorial implicit step": ("tutorial implicit step", RED, "P", ":"),
    "odeint symplectic_euler": ("odeint symplectic Euler", BLUE, "o", ":"),
    "odeint runge_kutta_dopri5": ("odeint dopri5", ORANGE, "s", ":"),
    "CVODE Adams": ("CVODE Adams", SKY, "<", ":"),
    "CVODE BDF": ("CVODE BDF", SKY, ">", ":"),
}


def read(folder, name):
    with open(Path(folder) / name, newline="") as file:
        return list(csv.DictReader(file))


def save(figure, folder, name):
    figure.savefig(Path(folder) / name, bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)


def work_precision(source, target):
    rows = read(source, "work_precision.csv")
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    drawn = set()
    figure, axes = plt.subplots(1, len(scenes), figsize=(4.1 * len(scenes), 4.0), sharey=True)
    for axis, scene in zip(axes, scenes):
        series = defaultdict(list)
        for row in rows:
            error = float(row["position_error"])
            if row["scene"] == scene and row["finished"] == "1" and error < 1:
                series[row["integrator"]].append((float(row["cpu_ms_per_s"]), error))
        for name, (_, colour, marker, line) in INTEGRATORS.items():
            if series[name]:
                drawn.add(name)
                cost, error = zip(*series[name])
                axis.loglog(cost, error, color=colour, marker=marker, linestyle=line, linewidth=1.1,
                            markersize=5, markerfacecolor="white" if line == ":" else colour)
        axis.axvline(1000, color="#888888", linewidth=0.8, linestyle="--")
        axis.annotate("real time", (1000, axis.get_ylim()[0]), xytext=(-3, 4), rotation=90,
                      textcoords="offset points", color="#666666", fontsize=7.5, ha="right")
        axis.set_title(scene)
        axis.set_xlabel("processor time, ms per simulated s")
    axes[0].set_ylabel("RMS position error / largest displacement")
    handles = [Line2D([], [], color=colour, marker=marker, linestyle=line, label=label,
                      markerfacecolor="white" if line == ":" else colour)
               for name, (label, colour, marker, line) in INTEGRATORS.items() if name in drawn]
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=4)
    save(figure, target, "work_precision.svg")


TITLES = {"explicit_euler": "explicit Euler", "symplectic_euler": "symplectic Euler"}


def stability_map(source, target):
    cells = read(source, "stability_map.csv")
    limits = read(source, "stability_limits.csv")
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 4.4), sharey=True)
    for axis, method in zip(axes, TITLES):
        mine = [row for row in limits if row["method"] == method]
        alpha = [float(row["alpha_s"]) for row in mine]
        proved = [float(row["certified_s"]) for row in mine]
        refuted = [float(row["refuted_s"]) for row in mine]
        h = [float(row["h_s"]) for row in cells if row["method"] == method]
        low, high = min(h) / 1.05, max(h) * 1.05
        clip = lambda values: [min(max(value, low), high) for value in values]
        axis.fill_between(alpha, low, clip(proved), color="#cfe8dc", linewidth=0)
        axis.fill_between(alpha, clip(refuted), high, color="#f6d5c3", linewidth=0)
        axis.plot(alpha, clip(proved), color=GREEN, linewidth=1.2)
        axis.plot(alpha, clip(refuted), color=RED, linewidth=1.2, linestyle="--")
        for grew, marker, colour, size in ((False, ".", BLACK, 5), (True, "x", "#a03000", 7)):
            points = [(float(row["alpha_s"]), float(row["h_s"])) for row in cells
                      if row["method"] == method and (float(row["growth"]) >= 100) == grew]
            axis.scatter(*zip(*points), s=size, marker=marker, color=colour, linewidth=0.6,
                         rasterized=True)  # thousands of cells
        axis.set(xscale="log", yscale="log", xlim=(min(alpha), max(alpha)), ylim=(low, high),
                 xlabel="stiffness-proportional damping α, s", title=TITLES[method])
        axis.grid(False)
    axes[0].set_ylabel("time step h, s")
    figure.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=4, handles=[
        Patch(color="#cfe8dc", label="certified stable"),
        Patch(color="#f6d5c3", label="refuted by a vector"),
        Line2D([], [], color=BLACK, marker=".", linestyle="", label="simulation stayed bounded"),
        Line2D([], [], color="#a03000", marker="x", linestyle="", label="simulation grew 100-fold"),
    ])
    save(figure, target, "stability_map.svg")


def multipliers(source, target):
    rows = read(source, "multipliers.csv")
    figure, axes = plt.subplots(2, 2, figsize=(8.4, 8.4), sharex=True, sharey=True)
    turn = [2 * math.pi * i / 400 for i in range(401)]
    circle = ([math.cos(t) for t in turn], [math.sin(t) for t in turn])
    for line, method in zip(axes, TITLES):
        # The lens is where the first multiplier leaves the circle.
        above = [(float(row["re"]), float(row["im"])) for row in rows
                 if row["method"] == method and row["part_of_limit"] == "1.01"]
        worst = max(above, key=lambda p: math.hypot(*p))
        radius = math.hypot(*worst)
        width = min(0.15, 8 * (radius - 1))
        lens = (worst[0] / radius, worst[1] / radius)
        for axis, part in zip(line, ("0.99", "1.01")):
            mine = [row for row in rows if row["method"] == method and row["part_of_limit"] == part]
            points = [(float(row["re"]), float(row["im"])) for row in mine]
            inside = [p for p in points if math.hypot(*p) <= 1]
            outside = [p for p in points if math.hypot(*p) > 1]
            zoom = axis.inset_axes([0.45, 0.36, 0.28, 0.28])
            for panel in (axis, zoom):
                panel.fill(*circle, color="#eef4fa", linewidth=0)
                panel.plot(*circle, color=BLUE, linewidth=0.9)
                if inside:
                    panel.scatter(*zip(*inside), s=9, color=BLACK, linewidth=0)
                if outside:
                    panel.scatter(*zip(*outside), s=28, color="#c03000", marker="x")
            zoom.set(xlim=(lens[0] - width, lens[0] + width), ylim=(lens[1] - width, lens[1] + width))
            zoom.set_xticks([])
            zoom.set_yticks([])
            zoom.grid(False)
            axis.indicate_inset_zoom(zoom, edgecolor="#555555")
            radius = max(math.hypot(*p) for p in points)
            axis.set_title(f"{TITLES[method]}, {part} of the limit\n"
                           f"h = {float(mine[0]['h_s']):.3e} s, largest |μ| = {radius:.5f}")
            axis.set_aspect("equal")
            axis.set(xlim=(-1.25, 1.25), ylim=(-1.25, 1.25))
        line[0].set_ylabel("Im μ")
    for axis in axes[1]:
        axis.set_xlabel("Re μ")
    figure.legend(loc="upper center", bbox_to_anchor=(0.5, 0.04), ncol=3, handles=[
        Line2D([], [], color=BLUE, label="unit circle"),
        Line2D([], [], color=BLACK, marker="o", markersize=4, linestyle="",
               label="multiplier inside it or on it"),
        Line2D([], [], color="#c03000", marker="x", linestyle="", label="multiplier outside"),
    ])
    save(figure, target, "multipliers.svg")


def crossing(points):
    """The stiffness at which the implicit cost falls below the explicit one, on straight lines between
    logarithms; None if it does not."""
    points = sorted(points)
    for (k0, e0, i0), (k1, e1, i1) in zip(points, points[1:]):
        r0, r1 = math.log(i0 / e0), math.log(i1 / e1)
        if r0 > 0 >= r1:
            return math.exp(math.log(k0) + r0 / (r0 - r1) * math.log(k1 / k0))
    return None


def grid_costs(rows, goal, damping, pins):
    costs = defaultdict(list)
    for row in rows:
        if (row["goal"], row["damping"], row["pins"]) == (goal, damping, pins):
            costs[int(row["n"])].append((float(row["stiffness_n_per_m"]),
                                         float(row["explicit_cost_ms"]),
                                         float(row["implicit_cost_ms"])))
    return costs


def crossover(source, target):
    rows = read(source, "recommend_grid.csv")
    goals = {"stable": "stable is enough", "accurate": "modes to 10 Hz within 5 %"}
    figure, axes = plt.subplots(1, 3, figsize=(13.6, 4.0))
    colours = [BLACK, SKY, GREEN, ORANGE, RED]
    for axis, (goal, title) in zip(axes, goals.items()):
        for colour, (n, points) in zip(colours, sorted(grid_costs(rows, goal, "light", "pinned").items())):
            stiffness, explicit, implicit = zip(*sorted(points))
            axis.loglog(stiffness, explicit, color=colour, marker="o", markersize=3.5)
            axis.loglog(stiffness, implicit, color=colour, marker="^", markersize=3.5,
                        linestyle="--", markerfacecolor="white")
            axis.annotate(f"N = {n}", (stiffness[-1], explicit[-1]), xytext=(4, -2),
                          textcoords="offset points", color=colour, fontsize=7.5)
        axis.axhline(1000 / 60, color="#888888", linewidth=0.8, linestyle=":")
        axis.set(title=title + "\n(hanging, lightly damped)", xlabel="spring stiffness, N/m",
                 ylabel="processor time, ms a frame", xlim=(5, 3e8))
    styles = {"light": "-", "heavy": "--"}
    for goal, colour in (("stable", BLUE), ("accurate", RED)):
        for damping, style in styles.items():
            for pins, marker in (("pinned", "o"), ("free", "s")):
                found = [(n, crossing(points)) for n, points in
                         sorted(grid_costs(rows, goal, damping, pins).items())]
                found = [point for point in found if point[1]]
                if found:
                    axes[2].loglog(*zip(*found), color=colour, linestyle=style, marker=marker,
                                   markerfacecolor="white" if pins == "free" else colour)
    axes[2].set(title="where implicit steps begin to be cheaper\n", xlabel="N (N × N particles)",
                ylabel="spring stiffness, N/m", xticks=[8, 16, 32, 64, 100],
                xticklabels=["8", "16", "32", "64", "100"])
    axes[2].minorticks_off()
    axes[0].legend(handles=[
        Line2D([], [], color=BLACK, marker="o", markersize=4, label="symplectic Euler"),
        Line2D([], [], color=BLACK, marker="^", markersize=4, linestyle="--",
               markerfacecolor="white", label="best implicit"),
        Line2D([], [], color="#888888", linestyle=":", label="1/60 s"),
    ], loc="lower right", fontsize=7.5)
    axes[2].legend(handles=[
        Line2D([], [], color=BLUE, label="stable is enough"),
        Line2D([], [], color=RED, label="modes to 10 Hz within 5 %"),
        Line2D([], [], color=BLACK, linestyle="-", label="lightly damped"),
        Line2D([], [], color=BLACK, linestyle="--", label="heavily damped"),
        Line2D([], [], color=BLACK, linestyle="", marker="o", label="pinned"),
        Line2D([], [], color=BLACK, linestyle="", marker="s", markerfacecolor="white", label="free"),
    ], fontsize=7.5, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.tight_layout()
    save(figure, target, "crossover.svg")


def summary(source):
    rows = read(source, "recommend_grid.csv")
    print("| goal | cells | goal met | cost ≤ 1.3 × cheapest | largest ratio | cells with a mode to judge |")
    print("|---|---|---|---|---|---|")
    for goal in ("stable", "accurate", None):
        mine = [row for row in rows if goal in (row["goal"], None)]
        met = sum(row["pick_meets"] == "1" for row in mine)
        ratios = [float(row["ratio"]) for row in mine]
        cheap = sum(ratio <= 1.3 for ratio in ratios)
        judged = sum(int(row["modes_judged"]) > 0 for row in mine)
        print(f"| {goal or 'all'} | {len(mine)} | {met} | {cheap} ({100 * cheap / len(mine):.1f} %) | "
              f"{max(ratios):.2f} | {judged if goal != 'stable' else '–'} |")
    cells = read(source, "stability_map.csv")
    print("\n| method | analysis | cells | stayed bounded | grew 100-fold |\n|---|---|---|---|---|")
    for method in TITLES:
        for analysis in ("certified", "between", "refuted"):
            mine = [float(row["growth"]) for row in cells
                    if row["method"] == method and row["analysis"] == analysis]
            grew = sum(growth >= 100 for growth in mine)
            print(f"| {TITLES[method]} | {analysis} | {len(mine)} | {len(mine) - grew} | {grew} |")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, target = sys.argv[1:]
    Path(target).mkdir(parents=True, exist_ok=True)
    work_precision(source, target)
    stability_map(source, target)
    multipliers(source, target)
    crossover(source, target)
    summary(source)


if __name__ == "__main__":
    main()
