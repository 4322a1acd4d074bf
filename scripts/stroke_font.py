# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

"""Letters as lines, for labels in pictures that are drawn without any other program."""

# A stroke is a row of points, two digits each: x to the right, then y up; 2 is the line that letters
# stand on, 6 the height of small letters, 8 that of capitals. A stroke of more than two points is rounded.
GLYPHS = {
    "a": "444606024244 4642", "b": "0802 040646420204", "c": "454606024243", "d": "444606024244 4842",
    "e": "0444 44460602424243", "f": "381812 0636", "g": "444606024244 46424000", "h": "0802 04064642",
    "i": "1612 1818", "k": "0802 0446 1542", "l": "0802", "m": "0602 04063632 34366662", "n": "0602 04064642",
    "o": "444606024244", "p": "0600 040646420204", "r": "0602 040636", "s": "4546060444420203",
    "t": "181232 0636", "u": "06024244 4642", "v": "0622 2246", "w": "0612 1236 3652 5266",
    "x": "0642 0246", "y": "0622 4610",
    "G": "474808024244 4424", "E": "0802 0848 0535 0242", "J": "48420203", "T": "0848 2822",
    "0": "454808024245", "1": "0628 2822", "2": "07084845 4502 0242", "3": "0708484515 1545420203",
    "4": "3804 0444 3832", "5": "4808 0805 0546420203", "6": "48080242450504", "7": "0848 4812",
    "8": "254548080525 254542020525", "9": "02424808054546", ",": "1201", ".": "1212", ":": "1212 1515",
    "-": "0434"}
SPACE = 3  # between words; letters are 2 apart


def rounded(points):
    """Cuts the corners of a row of points, three times."""
    for _ in range(3 if len(points) > 2 else 0):
        cut = [points[0]]
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            cut += [((3 * ax + bx) / 4, (3 * ay + by) / 4), ((ax + 3 * bx) / 4, (ay + 3 * by) / 4)]
        points = cut + [points[-1]]
    return points


def lines(text):
    """The pieces of a line of text, pairs of points from (0, 0) on, capitals 6 high; and its width."""
    pieces, right = [], 0
    for letter in text:
        if letter == " ":
            right += SPACE
            continue
        strokes = [[(int(s[i]), int(s[i + 1]) - 2) for i in range(0, len(s), 2)]
                   for s in GLYPHS[letter].split()]
        for stroke in strokes:
            points = [(right + x, y) for x, y in rounded(stroke)]
            pieces += zip(points, points[1:])
        right += max(x for stroke in strokes for x, _ in stroke) + 2
    return pieces, right - 2
