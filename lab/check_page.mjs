// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node check_page.mjs site packages pictures
// Uses the page as a reader would, with the mouse, in Chromium without a window, at the width of a
// desk and of a phone. Leaves screenshots in `pictures`.

import { spawn } from "node:child_process";
import { resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const [site, packages, pictures] = process.argv.slice(2).map((path) => resolve(path));
const { chromium } = await import(pathToFileURL(`${packages}/node_modules/playwright-core/index.mjs`));

const server = spawn("python3", ["-u", "-m", "http.server", "--bind", "127.0.0.1", "--directory", site, "0"], { stdio: ["ignore", "pipe", "ignore"] });
const port = await new Promise((found, failed) => {
  server.once("exit", () => failed(new Error("python3 -m http.server ended")));
  server.stdout.on("data", (text) => /port (\d+)/.test(text) && found(/port (\d+)/.exec(text)[1]));
});

const wrong = [];
function expect(holds, words) {
  console.log(`${holds ? "good " : "WRONG"} ${words}`);
  if (!holds) wrong.push(words);
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

async function open(width, height, options = {}) {
  const page = await browser.newPage({ viewport: { width, height }, ...options });
  page.setDefaultTimeout(120_000); // a busy machine draws a frame in seconds
  page.problems = [];
  page.on("console", (message) => message.type() === "error" && page.problems.push(message.text()));
  page.on("pageerror", (error) => page.problems.push(error.message));
  page.on("request", (request) => new URL(request.url()).hostname !== "127.0.0.1" && !request.url().startsWith("data:") && page.problems.push(`asks for ${request.url()}`));
  await page.goto(`http://127.0.0.1:${port}/`);
  await page.addScriptTag({ path: fileURLToPath(new URL("../examples/report/painted.js", import.meta.url)) });
  await page.waitForFunction(() => window.labState && window.labState().steps > 0);
  return page;
}
const state = (page) => page.evaluate(() => window.labState());
const choose = (page, name) => page.locator("#methods").getByText(name, { exact: true }).click();
const shown = (page, selector) => page.locator(selector).isVisible();

/// Drags the slider's thumb until it stands at h, as a hand does: by what the page then shows.
async function dragStep(page, h) {
  await page.locator("#h").scrollIntoViewIfNeeded();
  const box = await page.locator("#h").boundingBox();
  const at = (value) => box.x + 8 + (box.width - 16) * (Math.log(value / 2e-5) / Math.log(5e-2 / 2e-5));
  const y = box.y + box.height / 2;
  await page.mouse.move(at((await state(page)).settings.h), y);
  await page.mouse.down();
  await page.mouse.move(at(h), y, { steps: 5 });
  await page.mouse.up();
  return (await state(page)).settings.h;
}

/// Waits until the cloth has blown up, or for so many steps; the most that particles swung and the
/// farthest that one went meanwhile.
async function watch(page, steps, seconds = 60) {
  const from = (await state(page)).steps;
  let swing = 0, far = 0;
  for (const until = Date.now() + 1000 * seconds; Date.now() < until;) {
    const now = await state(page);
    swing = Math.max(swing, now.ringing);
    far = Math.max(far, now.far);
    if (now.blown || now.steps - from >= steps) break;
    await page.waitForTimeout(50);
  }
  return { swing, far, taken: (await state(page)).steps - from, blown: (await state(page)).blown };
}

/// The share of the cloth's picture that is painted, and in how many colours.
function paintedView(page) {
  return page.evaluate(async () => {
    const source = document.getElementById("view");
    await new Promise(requestAnimationFrame);  // what WebGL drew is kept until the frame ends
    const copy = Object.assign(document.createElement("canvas"), { width: source.width, height: source.height });
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    return painted(context.getImageData(0, 0, copy.width, copy.height));
  });
}

async function checkLayout(page, name) {
  const { share, colours } = await paintedView(page);
  expect(share > 0.04 && colours > 16, `${name}: the cloth covers ${(100 * share).toFixed(0)} % of its picture in ${colours} colours`);
  const [wide, text] = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.querySelector("main").innerText]);
  expect(wide <= 0, `${name}: the page is no wider than the window`);
  expect(!/undefined|NaN|Infinity|null/.test(text), `${name}: every text has its value`);
}

async function clickThrough(page, name) {
  const EDGE = 1 / 23;
  const { limits, settings } = await state(page);
  expect(settings.h < limits.anyPose && limits.anyPose < limits.certified && limits.certified < limits.refuted,
    `${name}: starts at ${settings.h.toExponential(3)} s, limits ${[limits.anyPose, limits.certified, limits.refuted].map((h) => h.toExponential(3)).join(", ")} s`);
  await checkLayout(page, name);

  const below = await watch(page, 1500);
  expect(!below.blown && below.taken >= 1500 && below.swing < 0.01 * EDGE, `${name}: ${below.taken} certified steps, no swing above ${below.swing.toExponential(1)} m`);

  const high = await dragStep(page, 1.03 * limits.refuted);
  expect(high > limits.refuted && (await page.locator("#standing").textContent()) === "refuted", `${name}: h dragged to ${high.toExponential(3)} s, refuted`);
  await page.waitForFunction((far) => window.labState().ringing > far || window.labState().blown, EDGE / 20);
  await page.screenshot({ path: `${pictures}/${name}_growing.png` });
  const above = await watch(page, Infinity);
  expect(above.blown && (await shown(page, "#verdict")), `${name}: blows up, and the page says so: ${await page.locator('#reason').textContent()}`);
  await page.screenshot({ path: `${pictures}/${name}_blown.png`, fullPage: true });
  const words = await page.locator("#growth-words").textContent();
  const [measured, predicted] = (words.match(/[\d.]+\d/g) || []).map(Number);
  expect(predicted > 1.01 && Math.abs(measured / predicted - 1) < 0.1, `${name}: measured growth ${measured} a step, predicted ${predicted}`);
  const frozen = (await state(page)).steps;
  await page.waitForTimeout(300);
  expect((await state(page)).steps === frozen, `${name}: a cloth that has blown up stands still`);

  const low = await dragStep(page, 0.9 * limits.anyPose);
  await page.locator("#again").click();
  const back = await watch(page, 1500);
  expect(low < limits.anyPose && !back.blown && back.taken >= 1500 && back.swing < 0.01 * EDGE && !(await shown(page, "#verdict")),
    `${name}: reset and back at ${low.toExponential(3)} s, ${back.taken} steps, no swing above ${back.swing.toExponential(1)} m`);

  await choose(page, "Implicit Euler");
  const frame = await dragStep(page, 1 / 60);
  const whole = await watch(page, 150);
  const now = await state(page);
  expect(frame > 30 * limits.refuted && now.settings.method === 3 && now.limits.anyPose === Infinity, `${name}: implicit Euler at ${frame.toExponential(3)} s, every step certified`);
  expect(!whole.blown && whole.taken >= 150 && whole.far < 1.6 && !(await shown(page, "#verdict")), `${name}: keeps whole over ${whole.taken} steps, nothing farther than ${whole.far.toFixed(2)} m`);

  await choose(page, "Graph inertia");
  const heavy = await watch(page, 150);
  expect(!heavy.blown && heavy.taken >= 150 && heavy.far < 1.6 && (await state(page)).limits.anyPose === Infinity, `${name}: graph inertia at the same step keeps whole over ${heavy.taken} steps, nothing farther than ${heavy.far.toFixed(2)} m`);

  await choose(page, "Velocity Verlet");
  const again = await watch(page, Infinity);
  expect(again.blown, `${name}: velocity Verlet at the same step blows up after ${again.taken} steps`);
  await page.locator("#again").click();
  await page.locator("#use").click();
  const advised = await state(page);
  expect(advised.settings.h <= advised.limits.anyPose, `${name}: the recommended step, ${advised.settings.h.toExponential(3)} s, is certified at any pose`);

  // Four times the stiffness, half the step: k of a mode is proportional to it [T8].
  await choose(page, "Symplectic Euler");
  await page.locator("#alpha").focus();
  await page.keyboard.press("Home");
  const soft = (await state(page));
  await page.locator("#stiffness").focus();
  for (let i = 0; i < 30; ++i) await page.keyboard.press("ArrowRight");
  const stiff = await state(page);
  const ratio = (stiff.limits.anyPose / soft.limits.anyPose) * Math.sqrt(stiff.settings.stiffness / soft.settings.stiffness);
  expect(stiff.settings.stiffness > 1.9 * soft.settings.stiffness && Math.abs(ratio - 1) < 1e-3, `${name}: ${(stiff.settings.stiffness / soft.settings.stiffness).toFixed(3)} times the stiffness, ${(stiff.limits.anyPose / soft.limits.anyPose).toFixed(4)} times the certified step`);
}

try {
  for (const [name, width, height, options] of [["desktop", 1280, 900, {}], ["phone", 390, 844, { deviceScaleFactor: 2 }]]) {
    const page = await open(width, height, options);
    await clickThrough(page, name);
    expect(page.problems.length === 0, `${name}: no errors, nothing asked of the network${page.problems.map((p) => `; ${p}`).join("")}`);
    await page.close();
  }
} finally {
  await browser.close();
  server.kill();
}
if (wrong.length) {
  console.error(`check_page: ${wrong.length} wrong`);
  process.exit(1);
}
