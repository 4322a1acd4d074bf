// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// How coarse may it be? Asked of the shipped skirt, asked in vain, cancelled, and not asked.

import { grid, named } from "./check_mesh.mjs";
import { expect, paintedView, scene, settled, shown, state, text } from "./check_tools.mjs";

const answered = (page) => page.waitForFunction(() => !window.labState().coarse.busy && document.getElementById("coarse-words").textContent !== "");
const stepped = (page) => page.waitForFunction(() => !window.labState().coarse.stepping);
/// As a hand sets the slider, at one of its 161 places.
const setGoal = (page, place) => page.locator("#goal").fill(String(place));
const wide = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

/// The skirt at 5 % for half a second: fewer particles will do, and the page shows that they do.
export async function checkCoarse(page, name, pictures) {
  await scene(page, "Skirt");
  await page.waitForTimeout(500);
  const before = (await state(page)).coarse;
  expect(!before.busy && !before.found && before.goal === 0.05 && !(await shown(page, "#coarse-found")), `${name}: nothing is searched for before it is asked`);
  const begin = Date.now();
  await page.locator("#find").click();
  await answered(page);
  const { found } = (await state(page)).coarse;
  expect(found?.outcome === "coarse" && found.chosen.particles < 3072 / 10 && 2 * found.chosen.error <= 0.05 && found.cheaper > 50,
    `${name}: after ${((Date.now() - begin) / 1000).toFixed(1)} s: ${await text(page, "#coarse-words")}`);
  const caution = await text(page, "#coarse-more");
  expect(/particles at .* are estimated to stay within/.test(await text(page, "#coarse-words")) && /an estimate, not a certificate/.test(caution) && /step is certified/.test(caution), `${name}: ${caution}`);
  const chart = await text(page, "#coarse-chart");
  expect((await page.locator("#coarse-chart circle.certified").count()) === 1 && chart.includes(`${found.chosen.particles}, chosen`) && /goal 5\s%/.test(chart), `${name}: the chart marks the goal and the level that is chosen`);

  await stepped(page);
  await page.locator("#beside").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.labState().coarse.time > 0.5);
  const { coarse } = await state(page);
  const tooSlow = /would take more than a minute here/.test(await text(page, "#beside-words"));  // a busy machine
  expect(coarse.frames >= 31 && (tooSlow || coarse.apart > 0) && coarse.apart <= 0.05, `${name}: both meshes move, ${coarse.frames} pictures, at most ${(100 * coarse.apart).toPrecision(2)} % apart: ${await text(page, "#beside-words")}`);
  const { share } = await paintedView(page, "beside-view");
  expect(share > 0.03 && (await wide(page)) <= 0, `${name}: they cover ${(100 * share).toFixed(0)} % of their picture, and the page is no wider than the window`);
  await page.locator("#coarse").screenshot({ path: `${pictures}/${name}_coarse.png` });
}

/// What is found is of the scene as it was.
export async function checkCoarseCleared(page, name) {
  await page.locator("#stiffness").focus();
  await page.keyboard.press("ArrowRight");
  const { coarse } = await state(page);
  expect(!coarse.found && !coarse.shown && !(await shown(page, "#coarse-found")) && /no longer of this scene/.test(await text(page, "#coarse-words")), `${name}: a knob clears it: ${await text(page, "#coarse-words")}`);
  await settled(page);

  // Half a per cent is too much to ask of a coarse skirt; the slider asks by itself.
  await page.evaluate(() => (document.getElementById("coarse-words").textContent = ""));
  await setGoal(page, 0);
  await answered(page);
  const { found, shown: moving } = (await state(page)).coarse;
  expect(found?.outcome === "fine" && found.goal === 0.005 && !moving && !(await shown(page, "#beside")), `${name}: at 0.5 %: ${await text(page, "#coarse-words")} ${await text(page, "#coarse-more")}`);
  expect(/own 3072 particles are needed: .* estimated to err by .* \(goal 0\.5\s%/.test(await text(page, "#coarse-words")) && (await page.locator("#coarse-chart circle.certified").count()) === 0 && (await page.locator("#coarse-chart circle").count()) > 1,
    `${name}: the chart shows what was tried, and nothing chosen`);

  const cancelled = page.evaluate(() => new Promise((done) => {  // in the page: a search may end before anybody else looks
    const words = document.getElementById("coarse-progress-words");
    new MutationObserver((_changes, observer) => {
      if (!/run \d/.test(words.textContent)) return;
      observer.disconnect();
      done([words.textContent, document.querySelectorAll("#coarse.old").length]);
      document.getElementById("coarse-cancel").click();
    }).observe(words, { childList: true });
  }));
  await page.locator("#durations").getByText("2 s", { exact: true }).click();
  const [words, dimmed] = await cancelled;
  await page.waitForFunction(() => !window.labState().coarse.busy);
  const after = await state(page);
  expect(dimmed === 1 && !after.coarse.found && !after.coarse.busy && /Cancelled/.test(await text(page, "#coarse-words")) && !(await shown(page, "#searching")), `${name}: while “${words}”, the answer of before is dimmed, and then: ${await text(page, "#coarse-words")}`);

  await page.locator("#unpin").click();
  await settled(page);
  await page.locator("#find").click();
  await page.waitForFunction(() => window.labState().coarse.found);
  expect((await state(page)).coarse.found.outcome === "nothing_moves" && /Nothing moves for 2\ss/.test(await text(page, "#coarse-words")) && !(await shown(page, "#coarse-chart-box")), `${name}: without pins, after it was cancelled: ${await text(page, "#coarse-words")}`);

  await page.setInputFiles("#file", named("sheet.obj", grid(75, 75)));
  await page.waitForFunction(() => window.labState().scene === "sheet.obj" && !window.labState().busy);
  expect(!(await state(page)).coarse.found && (await text(page, "#coarse-words")) === "", `${name}: another scene begins without an answer`);
  await setGoal(page, 130);
  await page.waitForTimeout(1000);
  expect(!(await state(page)).coarse.busy && /5,625 particles .* only with the button/.test(await text(page, "#coarse-large")), `${name}: ${await text(page, "#coarse-large")}`);
}
