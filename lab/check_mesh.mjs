// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Meshes that the reader brings: good ones, broken ones, large ones; pins, axes, presets, reset.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { checkLayout, choose, dragStep, expect, paintedView, scene, settled, shown, state, text, watch } from "./check_tools.mjs";

const SKIRT = fileURLToPath(new URL("../examples/data/skirt.obj", import.meta.url));
export const named = (name, lines) => ({ name, mimeType: "text/plain", buffer: Buffer.from(Array.isArray(lines) ? lines.join("\n") : lines) });

/// Lets a file fall on the page, as from a folder.
async function drop(page, file) {
  const data = await page.evaluateHandle(({ name, words }) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([words], name));
    return transfer;
  }, { name: file.name, words: file.buffer.toString() });
  for (const event of ["dragenter", "dragover", "drop"]) await page.dispatchEvent("body", event, { dataTransfer: data });
}
const showsScene = (page, name) => page.waitForFunction((wanted) => window.labState().scene === wanted && !window.labState().busy, name);

/// A grid of triangles, 1 m wide, upright.
export function grid(columns, rows) {
  const lines = [];
  for (let r = 0; r < rows; ++r) for (let c = 0; c < columns; ++c) lines.push(`v ${(c / (columns - 1)).toFixed(6)} ${(r / (columns - 1)).toFixed(6)} 0`);
  for (let r = 0; r + 1 < rows; ++r) {
    for (let c = 0; c + 1 < columns; ++c) {
      const i = r * columns + c + 1;
      lines.push(`f ${i} ${i + 1} ${i + columns + 1}`, `f ${i} ${i + columns + 1} ${i + columns}`);
    }
  }
  return lines;
}

export async function checkSkirt(page, name, pictures) {
  const begin = Date.now();
  await drop(page, { ...named("skirt.obj", readFileSync(SKIRT)) });
  await showsScene(page, "skirt.obj");
  const seconds = (Date.now() - begin) / 1000;
  const { limits, pinned, size, settings } = await state(page);
  expect(seconds < 10 && size === 3072 && limits.anyPose > 0 && limits.certified > limits.anyPose && limits.refuted > limits.certified,
    `${name}: the dropped skirt has its limits after ${seconds.toFixed(2)} s: certified ${limits.certified.toExponential(4)} s, refuted ${limits.refuted.toExponential(4)} s`);
  expect(pinned.length === 64 && pinned[63] === 63, `${name}: its top edge, the waist of ${pinned.length} vertices, is pinned`);
  expect(settings.h < limits.anyPose, `${name}: it starts at a certified step, ${settings.h.toExponential(3)} s`);
  expect(/of 15,104 springs hold half/.test(await text(page, "#blamed")), `${name}: ${await text(page, "#blamed")}`);
  await checkLayout(page, name);
  const [withSprings, without] = [await paintedView(page), (await page.locator("#blame").click(), await page.waitForTimeout(1000), await paintedView(page))];
  await page.locator("#blame").click();
  expect(withSprings.colours > 1.5 * without.colours, `${name}: the springs that set the limit bring ${withSprings.colours} colours, without them there are ${without.colours}`);

  await page.locator("#pair").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => window.labState().pair.reach > 100 * window.labState().pair.kick);
  const { pair } = await state(page);
  const pairs = await paintedView(page, "pair-view");
  expect(pair.h[0] < limits.certified && pair.h[1] > limits.refuted && pairs.share > 0.03,
    `${name}: below and above the limit, at ${pair.h.map((h) => h.toExponential(3)).join(" and ")} s; after ${pair.taken} steps the one above is ${(pair.reach / pair.kick).toFixed(0)} times as far as kicked`);
  await page.locator("#pair").screenshot({ path: `${pictures}/${name}_pair.png` });
  await page.evaluate(() => scrollTo(0, 0));
  const view = await page.locator("#view").boundingBox();
  await page.mouse.move(view.x + view.width / 2, view.y + view.height / 2);
  await page.mouse.wheel(0, -500);  // nearer
  await dragStep(page, 1.1 * limits.refuted);
  await page.waitForFunction(() => window.labState().ringing > window.labState().edge / 3 || window.labState().blown);
  const { steps } = await state(page);
  await page.waitForFunction((wanted) => window.labState().steps >= wanted || window.labState().blown, steps + 16);
  const { y, height } = await page.locator(".bench").boundingBox();  // README's picture, by scripts/lab.sh --picture
  await page.screenshot({ path: `${pictures}/${name}_beyond.png`, fullPage: true, clip: { x: 0, y: 0, width: page.viewportSize().width, height: Math.ceil(y + height) } });
  const above = await watch(page, Infinity);
  expect(above.blown, `${name}: past its limit it blows up, ${above.taken} steps after its picture`);
}

const square = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0"];
const REFUSED = [
  ["broken.obj", [...square, "f 1 2 3", "f 1 3 9"], "Line 6: a corner is vertex 9; there are 4."],
  ["nan.obj", ["v 0 0 0", "v 1 nan 0"], 'Line 2: "nan" is no finite number.'],
  ["twice.obj", [...square, "", "f 1 2 2"], "Line 6: vertex 2 is a corner twice."],
  ["short.obj", ["v 0 0"], "Line 1: a vertex needs three finite numbers."],
  ["picture.obj", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "Line 1:"],
  ["letter.txt", ["Dear reader,", "this is no mesh."], "The file has 0 vertices and 0 faces or lines; a mesh in OBJ text form is needed."],
  ["edge.obj", [...square, "f 1 2 3", "f 1 3"], "Line 6: a face needs three corners."],
  ["points.obj", square, "The file has 4 vertices and 0 faces or lines; a mesh in OBJ text form is needed."],
  ["empty.obj", "", "The file is empty."],
  ["point.obj", ["v 1 1 1", "v 1 1 1", "v 1 1 1", "f 1 2 3"], "All vertices lie within a micrometre of vertex 1 (line 1). Is the unit right?"],
  ["far.obj", ["v 0 0 0", "v 1 0 0", "v 1e300 1 0", "f 1 2 3"], "With this scale vertex 3 (line 3) is more than 1000 km away."],
  ["huge.obj", grid(251, 200), "The file has 50200 vertices; the lab takes up to 50000."],
];

export async function checkFiles(page, name) {
  const before = (await state(page)).scene;
  for (const [file, lines, words] of REFUSED) {
    await page.setInputFiles("#file", named(file, lines));
    await page.waitForFunction(() => !window.labState().busy && !document.getElementById("wrong").hidden && document.getElementById("wrong").textContent !== "");
    const said = await text(page, "#wrong");
    expect(said.startsWith(words) && (await state(page)).scene === before, `${name}: ${file}: ${JSON.stringify(said)}`);
    await page.evaluate(() => (document.getElementById("wrong").textContent = ""));
  }
  // One that is odd, but a mesh.
  await page.setInputFiles("#file", named("odd.obj", ["# z up", ...square, "v 0 1 0", "v 7 7 7", "vv 0 0 0", "f 1 2 3", "f 1 3 4", "f 4 5 3"]));
  await showsScene(page, "odd.obj");
  const notes = await text(page, "#notes");
  expect(!(await shown(page, "#wrong")) && /1 vertex that no face or line uses is left out\./.test(notes) && /skipped 1 statement, the first in line 8 \(1 "vv"\)\./.test(notes) && /1 spring has no length: the first joins vertex 4 \(line 5\) and vertex 5 \(line 6\)/.test(notes), `${name}: odd.obj: ${notes}`);
  await page.locator("#weld").check();
  await page.waitForFunction(() => window.labState().size === 4 && !window.labState().busy);
  expect(/1 vertex/.test(await text(page, "#notes")), `${name}: welded it has ${(await state(page)).size} particles: ${await text(page, "#notes")}`);
}

export async function checkPins(page, name) {
  await page.setInputFiles("#file", named("square.obj", grid(12, 12)));
  await showsScene(page, "square.obj");
  const top = await state(page);
  expect(top.pinned.length === 12 && Math.abs(top.high[2] - 1) < 1e-9, `${name}: y is up, ${top.pinned.length} particles of the top edge are pinned`);
  await page.locator("#unpin").click();
  await settled(page);
  expect((await state(page)).pinned.length === 0 && /gravity is off/.test(await text(page, "#scene")), `${name}: without pins: ${await text(page, "#scene")}`);
  const at = await page.evaluate(() => window.labView.pointOf(77));
  await page.mouse.click(...at);
  await settled(page);
  expect((await state(page)).pinned.join() === "77", `${name}: a click pins the particle under it: ${(await state(page)).pinned.join()}`);
  await page.waitForTimeout(300);
  const again = await page.evaluate(() => window.labView.pointOf(77));
  await page.mouse.click(...again);
  await settled(page);
  expect((await state(page)).pinned.length === 0, `${name}: a second one lets go of it`);
  await page.locator("#pin-top").click();
  await settled(page);
  expect((await state(page)).pinned.length === 12, `${name}: the top edge is pinned again`);

  await page.selectOption("#up", "0");
  await page.waitForFunction(() => Math.abs(window.labState().high[0] - 1) < 1e-9 && window.labState().high[1] === 0 && !window.labState().busy);
  await page.selectOption("#unit", "cm");
  await page.waitForFunction(() => Math.abs(window.labState().high[2] - 0.01) < 1e-9 && !window.labState().busy);
  expect(true, `${name}: x is up and the unit is cm: ${await text(page, "#scene")}`);
  await page.selectOption("#unit", "factor");
  await page.locator("#factor").fill("2.5");
  await page.locator("#factor").press("Enter");
  await page.waitForFunction(() => Math.abs(window.labState().high[2] - 2.5) < 1e-9 && !window.labState().busy);
  await page.locator("#factor").fill("-1");
  await page.locator("#factor").press("Enter");
  expect(/above 0/.test(await text(page, "#wrong")), `${name}: a scale of −1: ${await text(page, "#wrong")}`);

  // What was set by hand stays; the second of two quick choices does not undo the first.
  await page.locator("#mass").focus();
  await page.keyboard.press("ArrowRight");
  await page.locator("#unpin").click();
  await settled(page);
  const own = await state(page);
  await page.evaluate(() => {
    for (const [id, value] of [["up", "1"], ["unit", "m"]]) {
      document.getElementById(id).value = value;
      document.getElementById(id).dispatchEvent(new Event("change"));
    }
  });
  await page.waitForFunction(() => Math.abs(window.labState().high[2] - 1) < 1e-9 && !window.labState().busy);
  const kept = await state(page);
  expect(kept.settings.mass === own.settings.mass && kept.preset === null && kept.pinned.length === 0,
    `${name}: y is up again and the unit is m, chosen at once; ${kept.settings.mass.toPrecision(3)} kg and no pins stay as they were set`);
}

export async function checkReset(page, name) {
  await scene(page, "Flag");
  const first = await state(page);
  expect(first.preset === "flag" && first.pinned.length === 25, `${name}: the flag begins with its preset, on its pole of ${first.pinned.length} pins`);
  for (const preset of ["Silk", "Denim", "Net", "Flag", "Rope"]) {
    const before = (await state(page)).limits.certified;
    await page.locator("#presets").getByText(preset, { exact: true }).click();
    await settled(page);
    const { limits, settings } = await state(page);
    expect(limits.certified > 0 && limits.certified !== before, `${name}: ${preset}: ${settings.stiffness} N/m, ${settings.mass.toPrecision(3)} kg, certified ${limits.certified.toExponential(3)} s`);
  }
  await page.locator("#mass").focus();
  await page.keyboard.press("ArrowRight");
  await choose(page, "Implicit Euler");
  await page.locator("#unpin").click();
  await page.locator("#blame").uncheck();
  const box = await page.locator("#view").boundingBox();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 300, box.y + 160, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  const changed = await state(page);
  await page.locator("#reset").click();
  await page.waitForFunction(() => document.getElementById("reset-words").textContent !== "");
  const last = await state(page);
  const same = (key) => JSON.stringify(first[key]) === JSON.stringify(last[key]);
  const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 1e-9);
  expect(["settings", "limits", "pinned", "preset", "scene"].every(same) && near(first.camera, last.camera) && !near(first.camera, changed.camera) && (await page.locator("#blame").isChecked()),
    `${name}: reset brings everything back: ${await text(page, "#reset-words")}`);
  await scene(page, "Net");
  await checkLayout(page, `${name}, the net`);
}

/// 50 000 vertices, cancelled and then not.
export async function checkLarge(page, name) {
  const large = named("large.obj", grid(250, 200));
  const before = (await state(page)).scene;
  await page.setInputFiles("#file", large);
  await page.locator("#cancel").click();
  await settled(page);
  expect((await state(page)).scene === before && /Cancelled/.test(await text(page, "#wrong")), `${name}: cancelled: ${await text(page, "#wrong")}`);
  const begin = Date.now();
  const words = new Set();
  await page.setInputFiles("#file", large);
  const done = showsScene(page, "large.obj");
  for (let waiting = true; waiting;) {
    waiting = await Promise.race([done.then(() => false), page.waitForTimeout(60).then(() => true)]);
    if (await shown(page, "#working")) words.add(await text(page, "#progress-words"));
  }
  const { size, limits } = await state(page);
  expect(size === 50_000 && limits.certified > 0 && words.size > 0, `${name}: ${size} vertices have their limits after ${((Date.now() - begin) / 1000).toFixed(2)} s, certified ${limits.certified.toExponential(3)} s; meanwhile: ${[...words].join(", ")}`);
  const { share } = await paintedView(page);
  expect(share > 0.03, `${name}: it covers ${(100 * share).toFixed(0)} % of its picture`);
  await page.locator("#stiffness").focus();
  await page.evaluate(() => {  // a busy machine may be done before anybody looks
    window.standings = [];
    const standing = document.getElementById("standing");
    new MutationObserver(() => window.standings.push(standing.textContent)).observe(standing, { childList: true });
  });
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.standings.length > 0 && !window.labState().stale && !window.labState().busy);
  const between = (await page.evaluate(() => window.standings))[0];
  expect(between === "not known" && /certified/.test(await text(page, "#standing")), `${name}: while a knob’s limits are being found the step is “${between}”, then “${await text(page, "#standing")}”`);
}
