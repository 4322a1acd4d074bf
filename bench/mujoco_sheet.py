# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

"""What a frame of the cape's sheet costs MuJoCo: 48 x 64 particles as a flex of springs of
1 000 N/m, its first row pinned, falls on one capsule that stands. Its springs push, too; the soft
ones are left out. Needs the package mujoco. Prints Markdown."""

import statistics
import time

import mujoco

COLUMNS, ROWS, MASS = 48, 64, 8.7e-5
FRAME, FRAMES = 1 / 60, 18
STEPS = 119  # a frame, as many as Taut takes


def sheet(steps, integrator):
    points = " ".join(f"{0.02 * c:.5f} {0.0183 * r:.5f} 1" for r in range(ROWS) for c in range(COLUMNS))
    ends = []
    for i in range(ROWS * COLUMNS):
        right, down = i % COLUMNS + 1 < COLUMNS, i // COLUMNS + 1 < ROWS
        ends += [(i, i + 1)] if right else []
        ends += [(i, i + COLUMNS)] if down else []
        ends += [(i, i + COLUMNS + 1), (i + 1, i + COLUMNS)] if right and down else []
    springs = " ".join(f"{a} {b}" for a, b in ends)
    pins = " ".join(map(str, range(COLUMNS)))
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
  <option timestep="{FRAME / steps}" integrator="{integrator}" gravity="0 0 -9.81"/>
  <size memory="1G"/>
  <worldbody>
    <geom type="capsule" size="0.1" fromto="0 .5 .85 1 .5 .85" friction="0.3"/>
    <flexcomp name="sheet" type="direct" dim="1" mass="{ROWS * COLUMNS * MASS}" radius="0.005"
        point="{points}" element="{springs}">
      <edge stiffness="1000" damping="0"/>
      <contact selfcollide="none" friction="0.3"/>
      <pin id="{pins}"/>
    </flexcomp>
  </worldbody></mujoco>""")


def row(steps, integrator):
    model = sheet(steps, integrator)
    data = mujoco.MjData(model)
    falling, touching, fastest = [], [], 0
    for _ in range(FRAMES):
        start = time.process_time()
        touched = False
        for _ in range(steps):
            mujoco.mj_step(model, data)
            touched = touched or data.ncon > 0
        (touching if touched else falling).append(1e3 * (time.process_time() - start))
        fastest = max(fastest, abs(data.qvel).max())
    exploded = "yes" if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number > 0 or fastest > 100 else "no"
    touching = f"{statistics.median(touching):.0f} | {max(touching):.0f}" if touching else "– | –"
    print(f"| {integrator}, {steps} steps a frame | {statistics.median(falling):.0f} | {touching} | {exploded} |")


print(f"\n## MuJoCo {mujoco.__version__}: the cape's sheet alone, as a flex, on one capsule that stands, 0.3 s\n\n"
      "| | a frame while it falls, ms | while it touches, ms: median | worst | exploded |\n|---|---|---|---|---|")
row(STEPS, "Euler")
row(20, "Euler")
row(20, "implicitfast")
