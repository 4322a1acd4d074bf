#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

"""Builds and runs examples/scenes/NAME.cpp and draws the OBJ files that it writes as
docs/images/scenes/NAME.png; of thrown.cpp, docs/images/thrown.png, and of examples/cape.cpp, docs/images/cape.png.

Needs Python 3, a C++ compiler and Eigen, nothing else. Usage: scene_pictures.py [NAME...]; without a
name, all. $CXX names the compiler, $EIGEN Eigen's folder.
"""

import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

import stroke_font

ROOT = Path(__file__).resolve().parent.parent
WIDTH, MOST, MARGIN, SAMPLES = 640, 420, 18, 2  # pixels, and the square root of samples a pixel
BACK, SHADOW = (246, 247, 249), (217, 222, 227)
LIGHT = (0.36, -0.48, 0.80)  # towards it, z up, of length 1


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def less(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    size = math.sqrt(dot(a, a)) or 1
    return (a[0] / size, a[1] / size, a[2] / size)


def centre(points):
    return tuple(sum(x) / len(points) for x in zip(*points))


def mix(a, b, share):
    return tuple(x + share * (y - x) for x, y in zip(a, b))


class Picture:
    """Triangles, lines and balls in parallel projection: collected first, then drawn by a depth buffer."""

    def __init__(self, turn, tilt, width=WIDTH, most=MOST):
        """The camera's angles, degrees; the width and the largest height, pixels."""
        self.width, self.most = width, most
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        up, down = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
        self.axes = (c, -s, 0), (down * s, down * c, up), (-up * s, -up * c, down)  # right, up, to the eye
        self.shapes = []

    def place(self, p):
        return tuple(dot(axis, p) for axis in self.axes)

    def triangle(self, corners, lights, colour, shadow=False):
        self.shapes.append(("triangle", [self.place(p) for p in corners], lights, colour, shadow))

    def line(self, a, b, width, colour):
        self.shapes.append(("line", [self.place(a), self.place(b)], width / 2, colour, False))

    def ball(self, centre, radius, colour):
        self.shapes.append(("ball", [self.place(centre)], radius, colour, False))

    def text(self, middle, height, words, colour):
        """A line of text that faces the eye, its middle there, capitals of that height."""
        size = height / 6
        pieces, width = stroke_font.lines(words)
        right, up, _ = self.axes
        for piece in pieces:
            ends = [tuple(m + size * ((x - width / 2) * r + y * u) for m, r, u in zip(middle, right, up))
                    for x, y in piece]
            self.shapes.append(("ink", [self.place(p) for p in ends], 0.36 * size, colour, False))

    def rows(self):
        """Rows of (red, green, blue)."""
        ends = [(p, s[2] if s[0] != "triangle" else 0) for s in self.shapes for p in s[1]]
        left, right = min(p[0] - r for p, r in ends), max(p[0] + r for p, r in ends)
        low, high = min(p[1] - r for p, r in ends), max(p[1] + r for p, r in ends)
        pixels = min((self.width - 2 * MARGIN) / (right - left), (self.most - 2 * MARGIN) / (high - low))  # per m
        self.wide = self.width * SAMPLES
        self.tall = round(pixels * (high - low) + 2 * MARGIN) * SAMPLES
        self.scale = pixels * SAMPLES
        self.x0 = self.wide / 2 - self.scale * (left + right) / 2
        self.y0 = MARGIN * SAMPLES + self.scale * high
        self.depth = [-1e9] * (self.wide * self.tall)
        self.colour = [BACK] * (self.wide * self.tall)
        eye = unit(self.place(LIGHT))
        for kind, points, size, colour, shadow in sorted(self.shapes, key=lambda shape: not shape[4]):
            placed = [(self.x0 + self.scale * p[0], self.y0 - self.scale * p[1], p[2]) for p in points]
            if kind == "triangle":
                self.fill_triangle(placed, size, colour, shadow)
            elif kind in ("line", "ink"):
                self.fill_line(placed, size, colour, eye if kind == "line" else None)
            else:
                self.fill_ball(placed[0], size, colour, eye)
        across = range(SAMPLES)
        return [[tuple(sum(self.colour[(y * SAMPLES + j) * self.wide + x * SAMPLES + i][c]
                           for i in across for j in across) // SAMPLES ** 2 for c in range(3))
                 for x in range(self.width)] for y in range(self.tall // SAMPLES)]

    def box(self, points, margin=0):
        x = range(max(0, int(min(p[0] for p in points) - margin)),
                  min(self.wide, int(max(p[0] for p in points) + margin) + 1))
        y = range(max(0, int(min(p[1] for p in points) - margin)),
                  min(self.tall, int(max(p[1] for p in points) + margin) + 1))
        return x, y

    def put(self, x, y, z, colour, light):
        at = y * self.wide + x
        if z >= self.depth[at]:
            self.depth[at] = z
            self.colour[at] = tuple(min(255, int(c * light)) for c in colour)

    def fill_triangle(self, points, lights, colour, shadow):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = points
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            return
        across, down = self.box(points)
        for y in down:
            for x in across:
                u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
                v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
                if u < -1e-9 or v < -1e-9 or u + v > 1 + 1e-9:
                    continue
                if shadow:
                    self.colour[y * self.wide + x] = colour
                    continue
                w = 1 - u - v
                self.put(x, y, w * az + u * bz + v * cz, colour,
                         w * lights[0] + u * lights[1] + v * lights[2])

    def fill_line(self, points, half, colour, eye):
        (ax, ay, az), (bx, by, bz) = points
        dx, dy = bx - ax, by - ay
        square, size = dx * dx + dy * dy or 1, half * self.scale
        across, down = self.box(points, size)
        for y in down:
            for x in across:
                t = min(1, max(0, ((x - ax) * dx + (y - ay) * dy) / square))
                ox, oy = (x - ax - t * dx) / size, (y - ay - t * dy) / size
                left = 1 - ox * ox - oy * oy
                if left >= 0:
                    n = (ox, -oy, math.sqrt(left))
                    self.put(x, y, az + t * (bz - az) + half * n[2], colour, lit(dot(n, eye)) if eye else 1)

    def fill_ball(self, centre, radius, colour, eye):
        self.fill_line([centre, centre], radius, colour, eye)


def lit(cosine):
    return 0.62 + 0.48 * max(-0.5, cosine)


def read(path, up):
    """Vertices (z up, m), faces and lines of an OBJ file, corners from 0."""
    vertices, faces, lines = [], [], []
    for text in path.read_text().splitlines():
        kind, *words = text.split()
        if kind == "v":
            x, y, z = map(float, words)
            vertices.append((x, -z, y) if up == "y" else (x, y, z))
        else:
            (faces if kind == "f" else lines).append([int(word) - 1 for word in words])
    return vertices, faces, lines


def add_faces(picture, vertices, faces, colour_of, flat, floor):
    """Lit smoothly, or each face evenly; with a shadow on a floor at the height 0."""
    fans = [(f[0], f[k], f[k + 1], i) for i, f in enumerate(faces) for k in range(1, len(f) - 1)]
    normals = [(0, 0, 0)] * len(vertices)
    for *face, _ in fans:
        a, b, c = (vertices[i] for i in face)
        n = cross(less(b, a), less(c, a))
        for i in face:
            normals[i] = tuple(x + y for x, y in zip(normals[i], n))
    normals = [unit(n) for n in normals]
    for *face, i in fans:
        corners = [vertices[k] for k in face]
        n = unit(cross(less(corners[1], corners[0]), less(corners[2], corners[0])))
        side = 1 if dot(n, picture.axes[2]) >= 0 else -1  # of the two, the one that is seen
        lights = [lit(side * dot(n if flat else normals[k], LIGHT)) for k in face]
        if floor:
            picture.triangle([(p[0] - p[2] * LIGHT[0] / LIGHT[2], p[1] - p[2] * LIGHT[1] / LIGHT[2], 0)
                              for p in corners], lights, SHADOW, shadow=True)
        picture.triangle(corners, lights, colour_of(i))


WOOD, ROPE, STEEL, ORANGE = (190, 146, 96), (122, 96, 68), (150, 156, 162), (232, 126, 44)
RED, WHITE, BLUE, TEAL = (204, 68, 60), (240, 238, 232), (52, 108, 164), (94, 176, 190)
INK, SKIN = (52, 58, 66), (222, 192, 160)


def flag(read_frame):
    picture = Picture(20, 6)
    vertices, faces, _ = read_frame("flag", "y")
    stripes = [RED, WHITE, BLUE]
    add_faces(picture, vertices, faces, lambda i: stripes[i // 36 // 8], False, False)
    picture.line((-0.02, 0, -0.15), (-0.02, 0, 1.06), 0.04, STEEL)
    return picture


def bridge(read_frame):
    picture = Picture(24, 14)
    vertices, faces, lines = read_frame("bridge", "z")
    add_faces(picture, vertices, faces, lambda i: mix(WOOD, ROPE, 0.35 * (i % 2)), True, False)
    for a, b in lines:
        picture.line(vertices[a], vertices[b], 0.05, ROPE)
    for end in (0, len(vertices) - 5):
        for side in (0, 1):
            x, y, z = vertices[end + side]
            picture.line((x, y, z - 1), (x, y, z + 1.15), 0.16, WOOD)
    picture.ball(vertices[-1], 0.32, ORANGE)
    return picture


def rope(read_frame):
    picture = Picture(0, 0)
    frames = list(range(0, 22, 2))
    for frame in frames:
        fade = 0.75 * (1 - frame / frames[-1])
        vertices, _, lines = read_frame("rope%05d" % frame, "y")
        vertices = [(x, y - frame, z) for x, y, z in vertices]  # later ones in front
        for a, b in lines:
            picture.line(vertices[a], vertices[b], 0.012, mix(ROPE, BACK, fade))
        picture.ball(vertices[-1], 0.05, mix(ORANGE, BACK, fade))
    return picture


def soft_cube(read_frame):
    picture = Picture(18, 16)
    for index, frame in enumerate((0, 18, 33, 170)):  # side by side, turned so that it tumbles to the right
        vertices, faces, _ = read_frame("soft_cube%05d" % frame, "z")
        middle = sum(x for x, _, _ in vertices) / len(vertices)
        vertices = [(0.56 * index + middle - x, -y, z) for x, y, z in vertices]
        add_faces(picture, vertices, faces, lambda i: mix(TEAL, WHITE, 0.3 * ((i // 6 + i) % 2)), True, True)
    return picture


def net(read_frame):
    picture = Picture(28, 24)
    for index, frame in enumerate((0, 12)):
        vertices, _, lines = read_frame("net%05d" % frame, "z")
        vertices = [(x + 1.55 * index, y - 0.75 * index, z) for x, y, z in vertices]
        knots = {i for line in lines for i in line}
        for a, b in lines:
            picture.line(vertices[a], vertices[b], 0.009, ROPE)
        for i in range(len(vertices)):
            if i not in knots:
                picture.ball(vertices[i], 0.026, ORANGE)
    return picture


def curtain(read_frame):
    picture = Picture(8, 5)
    for frame, at in ((0, 0), (22, 2.15), (69, 3.6)):
        vertices, faces, _ = read_frame("curtain%05d" % frame, "y")
        vertices = [(x + at, y, z) for x, y, z in vertices]
        add_faces(picture, vertices, faces, lambda i: (188, 62, 78), False, False)
    picture.line((-0.1, 0, 0.03), (4.55, 0, 0.03), 0.04, STEEL)
    return picture


def thrown(read_frame):
    picture = Picture(24, 8, 1200, 700)
    right, up, _ = picture.axes
    halves, low = [], 0
    for at, name, method in ((-0.72, "others", "symplectic Euler"), (0.72, "taut", "Taut, Guarded")):
        vertices, faces, _ = read_frame("thrown_" + name, "z")
        vertices = [tuple(p + (at - right[0] / 2) * r for p, r in zip(v, right)) for v in vertices]
        low = min([low] + [dot(v, up) for v in vertices])
        add_faces(picture, vertices, faces, lambda i: WHITE if i // 63 // 9 % 2 else RED, False, False)
        for pin in (0, 63):
            picture.ball(vertices[pin], 0.018, STEEL)
        fact = method.split()[-1] + r", (\d+) steps of .*: (\S+) J become (\S+) J"
        steps, before, now = (round(float(n)) for n in re.search(fact, read_frame.printed).groups())
        halves.append((at, f"{method}: {steps} steps a frame", f"{before} J became {now} J"))
    for at, *lines in halves:
        for line, words in enumerate(lines):
            middle = [at * r + (low - 0.09 - 0.1 * line) * u for r, u in zip(right, up)]
            picture.text(middle, 0.045, words, INK)
    return picture


def cape(read_frame):
    picture = Picture(0, 7, 1200, 500)
    _, faces, _ = read_frame("cape", "z")
    motion = (read_frame.folder / "cape.pc2").read_bytes()
    count, = struct.unpack_from("<i", motion, 16)
    skin = count - 14 * 96  # the figure's points are last, a pelvis first
    cloths = 47 * 63, 64 * 19  # faces
    colours = [RED] * cloths[0] + [BLUE] * cloths[1]
    across = 0
    for frame, turn, width in ((50, 62, 0), (108, 22, 1.15), (165, -8, 1.5), (230, 28, 1.65)):
        numbers = struct.unpack_from("<%df" % (3 * count), motion, 32 + 12 * count * frame)
        points = list(zip(*[iter(numbers)] * 3))
        right, left = (centre(points[skin + k:skin + k + 12]) for k in (0, 84))
        middle, ahead = mix(right, left, 0.5), math.atan2(right[0] - left[0], left[1] - right[1])
        c, s = math.cos(math.radians(turn) - ahead), math.sin(math.radians(turn) - ahead)
        across += width
        vertices = [(c * (x - middle[0]) - s * (y - middle[1]) + across,
                     s * (x - middle[0]) + c * (y - middle[1]), z) for x, y, z in points]
        add_faces(picture, vertices, faces, lambda i: colours[i] if i < len(colours) else SKIN, False, True)
    return picture


SCENES = {f.__name__: f for f in (flag, bridge, rope, soft_cube, net, curtain, thrown, cape)}
MAIN = ("thrown", "cape")  # not among the examples' scenes


def png(rows):
    """The bytes of a PNG file of the 256 colours that occur most; others are replaced by the nearest."""
    coarse = [[tuple(min(255, 4 * ((c + 2) // 4)) for c in pixel) for pixel in row] for row in rows]
    palette = [c for c, _ in Counter(p for row in coarse for p in row).most_common(256)]
    index = {c: i for i, c in enumerate(palette)}
    for pixel in {p for row in coarse for p in row} - set(palette):
        index[pixel] = min(range(len(palette)),
                           key=lambda i: sum((a - b) ** 2 for a, b in zip(palette[i], pixel)))
    data = b"".join(b"\0" + bytes(index[p] for p in row) for row in coarse)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"PLTE", b"".join(bytes(c) for c in palette))
            + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def draw(name, folder, printed):
    def read_frame(file, up):
        return read(folder / f"{file}.obj", up)

    read_frame.printed, read_frame.folder = printed, folder
    picture = SCENES[name](read_frame)
    target = ROOT / "docs" / "images" / ("" if name in MAIN else "scenes") / f"{name}.png"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(png(picture.rows()))
    print(f"{target.relative_to(ROOT)}: {target.stat().st_size / 1000:.0f} kB")


def main(names):
    for name in names or SCENES:
        with tempfile.TemporaryDirectory() as folder:
            program = f"{folder}/{name}"
            subprocess.run([os.environ.get("CXX", "g++"), "-std=c++17", "-O2", f"-I{ROOT}/include",
                            "-I" + os.environ.get("EIGEN", "/usr/include/eigen3"),
                            str(ROOT / "examples" / ("" if name == "cape" else "scenes") / f"{name}.cpp"),
                            "-o", program], check=True)
            printed = subprocess.run([program], cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout
            print(printed, end="")
            draw(name, Path(folder), printed)


if __name__ == "__main__":
    main(sys.argv[1:])
