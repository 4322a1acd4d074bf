// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The cloth that the page begins with: below and above its limits, by each integrator.

import { checkLayout, choose, dragStep, expect, settled, shown, state, text, watch } from "./check_tools.mjs";

export async function checkCloth(page, name, pictures) {
  const EDGE = 1 / 23;
  const { limits, settings } = await state(page);
  expect(settings.h < limits.anyPose && limits.anyPose < limits.certified && limits.certified < limits.refuted,
    `${name}: starts at ${settings.h.toExponential(3)} s, limits ${[limits.anyPose, limits.certified, limits.refuted].map((h) => h.toExponential(3)).join(", ")} s`);
  await checkLayout(page, name);

  const below = await watch(page, 1000);
  expect(!below.blown && below.taken >= 1000 && below.swing < 0.01 * EDGE, `${name}: ${below.taken} certified steps, no swing above ${below.swing.toExponential(1)} m`);

  const high = await dragStep(page, 1.03 * limits.refuted);
  expect(high > limits.refuted && (await text(page, "#standing")) === "refuted", `${name}: h dragged to ${high.toExponential(3)} s, refuted`);
  await page.waitForFunction((far) => window.labState().ringing > far || window.labState().blown, EDGE / 20);
  await page.screenshot({ path: `${pictures}/${name}_growing.png` });
  const above = await watch(page, Infinity);
  expect(above.blown && (await shown(page, "#verdict")), `${name}: blows up, and the page says so: ${await text(page, "#reason")}`);
  await page.screenshot({ path: `${pictures}/${name}_blown.png`, fullPage: true });
  const words = await text(page, "#growth-words");
  const [measured, predicted] = (words.match(/[\d.]+\d/g) || []).map(Number);
  expect(predicted > 1.01 && Math.abs(measured / predicted - 1) < 0.1, `${name}: measured growth ${measured} a step, predicted ${predicted}`);
  const frozen = (await state(page)).steps;
  await page.waitForTimeout(300);
  const still = await state(page);
  expect(still.steps === frozen, `${name}: a cloth that has blown up stands still`);

  const low = await dragStep(page, 0.9 * limits.anyPose);
  await page.locator("#again").click();
  const back = await watch(page, 1000);
  expect(low < limits.anyPose && !back.blown && back.taken >= 1000 && back.swing < 0.01 * EDGE && !(await shown(page, "#verdict")),
    `${name}: started again at ${low.toExponential(3)} s, ${back.taken} steps, no swing above ${back.swing.toExponential(1)} m`);

  await choose(page, "Implicit Euler");
  const frame = await dragStep(page, 1 / 60);
  const whole = await watch(page, 100);
  const now = await state(page);
  expect(frame > 30 * limits.refuted && now.settings.method === 3 && now.limits.anyPose === Infinity, `${name}: implicit Euler at ${frame.toExponential(3)} s, every step certified`);
  expect(!whole.blown && whole.taken >= 100 && whole.far < 1.3 && !(await shown(page, "#verdict")), `${name}: keeps whole over ${whole.taken} steps, nothing farther than ${whole.far.toFixed(2)} diagonals`);

  await choose(page, "Velocity Verlet");
  const again = await watch(page, Infinity);
  expect(again.blown, `${name}: velocity Verlet at the same step blows up after ${again.taken} steps`);
  await page.waitForTimeout(500);
  const { drawn, reach, camera } = await state(page);
  expect(reach > 2 && drawn <= 1.06 && Math.hypot(...camera) > 1.15, `${name}: particles are ${reach.toPrecision(2)} diagonals away, none is drawn farther than ${drawn.toFixed(2)}, the camera is at ${Math.hypot(...camera).toFixed(2)}`);
  await page.locator("#again").click();
  const safer = await state(page);
  expect(safer.settings.h < safer.limits.anyPose && !safer.blown, `${name}: it starts again at a certified step, ${safer.settings.h.toExponential(3)} s`);
  await page.waitForFunction(() => window.labState().plans.length > 0);
  await page.locator("#use").click();
  const advised = await state(page);
  expect(advised.settings.h <= advised.limits.anyPose, `${name}: the recommended step, ${advised.settings.h.toExponential(3)} s, is certified at any pose`);
  await checkPace(page, name);
  await checkEnergyStable(page, name);

  // Twice the stiffness, a step shorter by √2: k of a mode is proportional to it [T8].
  await choose(page, "Symplectic Euler");
  await page.locator("#alpha").focus();
  await page.keyboard.press("Home");
  await settled(page);
  const soft = await state(page);
  await page.locator("#stiffness").focus();
  for (let i = 0; i < 30; ++i) await page.keyboard.press("ArrowRight");
  await settled(page);
  const stiff = await state(page);
  const ratio = (stiff.limits.anyPose / soft.limits.anyPose) * Math.sqrt(stiff.settings.stiffness / soft.settings.stiffness);
  expect(stiff.settings.stiffness > 1.9 * soft.settings.stiffness && Math.abs(ratio - 1) < 1e-3, `${name}: ${(stiff.settings.stiffness / soft.settings.stiffness).toFixed(3)} times the stiffness, ${(stiff.limits.anyPose / soft.limits.anyPose).toFixed(4)} times the certified step`);

  // Without damping every vibration grows under explicit Euler, slowly at small steps.
  await page.locator("#drag").focus();
  await page.keyboard.press("Home");
  await choose(page, "Explicit Euler");
  await dragStep(page, 2.2e-5);
  await settled(page);
  const slow = await text(page, "#sentence");
  expect(/grows by [\d.]+\s% a step: it becomes visible after some [\d,]+ steps/.test(slow), `${name}: ${slow}`);
}

/// Energy-stable Euler has a limit of its own, half of the other at least, and keeps whole below it.
async function checkEnergyStable(page, name) {
  await choose(page, "Symplectic Euler");
  const linearised = (await state(page)).limits.anyPose;
  await choose(page, "Energy-stable Euler");
  const { limits } = await state(page);
  expect(limits.anyPose > 0.499 * linearised && limits.certified === limits.anyPose && limits.refuted > limits.certified,
    `${name}: energy-stable Euler is proved up to ${limits.anyPose.toExponential(3)} s, ${(limits.anyPose / linearised).toFixed(3)} of the linearised limit, and refuted from ${limits.refuted.toExponential(3)} s on`);
  const low = await dragStep(page, 0.99 * limits.anyPose);
  await page.locator("#start-again").click();
  const below = await watch(page, 1000);
  const words = await text(page, "#sentence");
  expect(low < limits.anyPose && !below.blown && below.taken >= 1000 && /no step adds energy/.test(words), `${name}: ${below.taken} steps of it at ${low.toExponential(3)} s: ${words}`);
  await dragStep(page, 1.03 * limits.refuted);
  const above = await watch(page, Infinity);
  expect(above.blown && /energy-stable/i.test(await text(page, "#reason")), `${name}: past that it blows up: ${await text(page, "#reason")}`);
}

/// What the readout says a frame costs is what the bars say, for the same integrator and step.
async function checkPace(page, name) {
  // The words of the step before stand until the next picture.
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  await page.waitForFunction(() => /takes [\d.]+\sms/.test(document.getElementById("pace").textContent));
  const read = Number(/takes ([\d.]+)\sms/.exec(await text(page, "#pace"))[1]);
  const { plans, settings } = await state(page);
  const bars = plans.filter((plan) => plan.method === settings.method).map((plan) => 1000 * plan.cost);
  expect(bars.some((ms) => Math.abs(read / ms - 1) < 0.05), `${name}: a frame takes ${read} ms by the readout, ${bars.map((ms) => ms.toPrecision(2)).join(" or ")} ms by the bars`);
}
