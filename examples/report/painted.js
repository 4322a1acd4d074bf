// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

/// The share of a picture that is painted, and in how many colours. For the tests of the pages.
function painted({ data: rgba }) {
  const colours = new Set();
  let count = 0;
  for (let i = 0; i < rgba.length; i += 4) {
    if (rgba[i + 3] === 0) continue;
    ++count;
    colours.add((rgba[i] << 16) | (rgba[i + 1] << 8) | rgba[i + 2]);
  }
  return { share: count / (rgba.length / 4), colours: colours.size };
}
