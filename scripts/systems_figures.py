#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

"""Draws docs/systems/*.svg from docs/systems/*.csv, which the program systems_figures writes.

Needs matplotlib (Debian: python3-matplotlib). Usage: systems_figures.py [FOLDER]
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

# Told apart in print by dashes, by the colour-blind by lightness (Okabe and Ito).
STYLES = [
    ("#000000", "-"),
    ("#d55e00", "--"),
    ("#0072b2", "-."),
    ("#009e73", ":"),
    ("#cc79a7", (0, (5, 1, 1, 1, 1, 1))),
]


def rows(folder, name):
    with open(folder / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def groups(table, *keys):
    """Rows by the values of some columns, in order of first appearance."""
    found = {}
    for row in table:
        found.setdefault(tuple(row[key] for key in keys), []).append(row)
    return found


def column(table, name):
    return [float(row[name]) for row in table]


def axes(x, y, columns=1):
    width = 5.2 if columns == 1 else 4.2 * columns
    figure, found = plt.subplots(1, columns, figsize=(width, 3.2), squeeze=False)
    for one in found[0]:
        one.set_xlabel(x)
        one.set_ylabel(y)
        one.grid(True, color="#dddddd", linewidth=0.6)
        one.set_axisbelow(True)
    return figure, list(found[0])


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)


def large_steps(folder):
    figure, (plot,) = axes("time, s", "lowest particle, m")
    for (colour, dash), ((method, h), part) in zip(STYLES, groups(rows(folder, "large_steps"), "method", "h_s").items()):
        end = part[-1]
        gone = float(end["time_s"]) < 1.9
        label = f"{method} Euler, h = {float(h) * 1e3:.2g} ms" + (" (explodes)" if gone else "")
        plot.plot(column(part, "time_s"), column(part, "lowest_m"), color=colour, linestyle=dash, label=label)
        if gone:
            plot.plot(float(end["time_s"]), max(-1.6, float(end["lowest_m"])), "x", color=colour)
    plot.set_ylim(-1.3, 1.0)
    plot.legend(fontsize=7, loc="upper right")
    save(figure, folder, "large_steps")


def strip(folder):
    figure, (rise, speed) = axes("stiffness k, N/m", "rise of the strip, m", 2)
    speed.set_ylabel("fastest particle, m/s")
    names = {"choi_ko": "Choi and Ko's springs", "hookean": "linear springs"}
    methods = {"bdf2": "BDF2", "implicit": "implicit Euler"}
    for (colour, dash), ((springs, method), part) in zip(STYLES, groups(rows(folder, "strip"), "springs", "method").items()):
        for plot, name in ((rise, "rise_m"), (speed, "fastest_m_per_s")):
            plot.semilogx(column(part, "stiffness_N_per_m"), column(part, name), color=colour, linestyle=dash,
                          marker=".", label=f"{names[springs]}, {methods[method]}")
    rise.set_ylim(0, 0.4)
    speed.set_ylim(0, 5)
    speed.legend(fontsize=7, loc="upper left")
    save(figure, folder, "strip")


def swing(folder):
    figure, (plot,) = axes("time, s", "share of the swing's energy left")
    names = {"bdf2": "BDF2", "implicit": "implicit Euler"}
    for (colour, dash), ((method,), part) in zip(STYLES, groups(rows(folder, "swing"), "method").items()):
        plot.plot(column(part, "time_s"), column(part, "energy_left"), color=colour, linestyle=dash, label=names[method])
    plot.set_ylim(0, 1.05)
    plot.legend()
    save(figure, folder, "swing")


def modal(folder):
    figure, (plot,) = axes("modes kept, r", "error, of the largest displacement")
    names = {"wind": "wind on all particles", "poke": "the same force on one particle"}
    for (colour, dash), ((force,), part) in zip(STYLES, groups(rows(folder, "modal"), "force").items()):
        plot.loglog(column(part, "r"), column(part, "relative_error"), color=colour, linestyle=dash, marker=".",
                    label=names[force])
    plot.legend()
    save(figure, folder, "modal")


def energy(folder):
    figure, plots = axes("step", "energy, J", 2)
    titles = {"linearised": "one linearised solve a step", "solved": "the step solved"}
    for plot, method in zip(plots, ("linearised", "solved")):
        table = [row for row in rows(folder, "energy") if row["method"] == method]
        for (colour, dash), ((h,), part) in zip(STYLES, groups(table, "h_s").items()):
            plot.plot(column(part, "step"), column(part, "energy_J"), color=colour, linestyle=dash, label=f"h = {float(h):.3g} s")
        plot.set_yscale("symlog", linthresh=1)
        plot.set_title(titles[method], fontsize=9)
        plot.legend(fontsize=7)
    low = min(plot.get_ylim()[0] for plot in plots)
    high = max(plot.get_ylim()[1] for plot in plots)
    for plot in plots:
        plot.set_ylim(low, high)
        plot.set_yticks([-1, 0, 1, 1e3, 1e6, 1e9, 1e12])
    save(figure, folder, "energy")


def contact(folder):
    figure, (plot,) = axes("along the cloth, m", "height, m")
    plot.add_patch(plt.Circle((0.45, -0.32), 0.3, color="#e8e8e8", label="sphere"))
    for (colour, dash), ((friction,), part) in zip(STYLES, groups(rows(folder, "contact"), "friction").items()):
        plot.plot(column(part, "along_m"), column(part, "height_m"), color=colour, linestyle=dash, label=f"friction {friction}")
    plot.set_aspect("equal")
    plot.set_xlim(-0.1, 1.5)
    plot.legend(fontsize=7, loc="center right")
    save(figure, folder, "contact")


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs" / "systems"
    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "taut", "svg.fonttype": "none"})
    for draw in (large_steps, strip, swing, modal, energy, contact):
        draw(folder)


main()
