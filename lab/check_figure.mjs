// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The figure that walks, runs and turns in a cape and a skirt: by Guarded at any frame, and by a
// step that blows up.

import { checkLayout, choose, dragStep, expect, paintedView, scene, shown, state, text, watch } from "./check_tools.mjs";

const SKIN = 1e-3;  // m below it, where what is no longer there may not be
const atTime = (page, seconds) => page.waitForFunction((until) => window.labState().time >= until || window.labState().blown, seconds);

/// The scene as it opens, and its motion.
export async function checkWalk(page, name, pictures, seconds) {
  await scene(page, "Figure in a cape");
  const first = await state(page);
  expect(first.settings.method === 6 && Math.abs(first.settings.h * 60 - 1) < 0.01 && first.preset === "cape" && first.limits.anyPose === Infinity,
    `${name}: opens with Guarded, a frame of ${first.settings.h.toExponential(3)} s`);
  await checkLayout(page, name);
  for (const at of [0.8, 2, 4, 6.5, 10].filter((at) => at <= seconds)) {
    await atTime(page, at);
    await page.locator(".stage").screenshot({ path: `${pictures}/${name}_${at}s.png` });
  }
  const { share } = await paintedView(page);
  expect(share > 0.03, `${name}: it covers ${(100 * share).toFixed(0)} % of its picture`);
  const walked = await state(page);
  const way = Math.hypot(walked.place[0], walked.place[1]);
  expect(!walked.blown && walked.time >= seconds && way > seconds / 2, `${name}: walks ${seconds} s, and is ${way.toFixed(1)} m from where it began; ${await text(page, "#pace")}`);
  expect(walked.depth < SKIN, `${name}: the deepest particle is ${(-1000 * walked.depth).toFixed(3)} mm above the skin`);
}

export async function checkFigure(page, name, pictures) {
  await checkWalk(page, name, pictures, 10);

  for (const [h, frames] of [[0.05, 20], [1 / 300, 100]]) {
    const set = await dragStep(page, h);
    const { taken, blown, far } = await watch(page, frames);
    const now = await state(page);
    expect(Math.abs(set / h - 1) < 0.02 && !blown && taken >= frames && far < 2 && now.depth < SKIN,
      `${name}: ${taken} frames of ${set.toExponential(3)} s: nothing farther than ${far.toFixed(2)} diagonals, the deepest ${(-1000 * now.depth).toFixed(3)} mm above the skin`);
  }

  await choose(page, "Energy-stable Euler");
  const { limits } = await state(page);
  await dragStep(page, 0.95 * limits.anyPose);
  await page.locator("#start-again").click();
  const stable = await watch(page, 300);
  const words = await text(page, "#sentence");
  expect(!stable.blown && stable.taken >= 300 && /Contact is part of the step/.test(words), `${name}: ${stable.taken} steps of energy-stable Euler: ${words}`);

  await choose(page, "Velocity Verlet");
  await dragStep(page, 1.5 * (await state(page)).limits.refuted);
  const bare = await watch(page, Infinity);
  expect(bare.blown && (await shown(page, "#verdict")), `${name}: velocity Verlet past its limit blows up: ${await text(page, "#reason")}`);
  await page.screenshot({ path: `${pictures}/${name}_blown.png` });
  await choose(page, "Guarded");
  await page.locator("#again").click();
  await atTime(page, 0.2);
  expect(!(await state(page)).blown && !(await shown(page, "#verdict")), `${name}: Guarded at the same step does not`);
}
