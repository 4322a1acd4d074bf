// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What the checks of the page share: a server, a browser, and hands.

import { spawn } from "node:child_process";
import { fileURLToPath, pathToFileURL } from "node:url";

const wrong = [];
export function expect(holds, words) {
  console.log(`${holds ? "good " : "WRONG"} ${words}`);
  if (!holds) wrong.push(words);
}
/// Ends the program, badly if something was wrong.
export function conclude() {
  if (wrong.length) console.error(`check_page: ${wrong.length} wrong:\n${wrong.map((words) => `  ${words}`).join("\n")}`);
  process.exit(wrong.length ? 1 : 0);
}

export async function serve(site) {
  const server = spawn("python3", ["-u", "-m", "http.server", "--bind", "127.0.0.1", "--directory", site, "0"], { stdio: ["ignore", "pipe", "ignore"] });
  const port = await new Promise((found, failed) => {
    server.once("exit", () => failed(new Error("python3 -m http.server ended")));
    server.stdout.on("data", (text) => /port (\d+)/.test(text) && found(/port (\d+)/.exec(text)[1]));
  });
  return { address: `http://127.0.0.1:${port}/`, stop: () => server.kill() };
}

export async function launch(packages) {
  const { chromium } = await import(pathToFileURL(`${packages}/node_modules/playwright-core/index.mjs`));
  return chromium.launch({
    executablePath: process.env.CHROMIUM || "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

/// The page, running; what it does wrong meanwhile is in page.problems.
export async function open(browser, address, width, height, options = {}) {
  const page = await browser.newPage({ viewport: { width, height }, ...options });
  page.setDefaultTimeout(120_000);  // a busy machine draws a frame in seconds
  page.problems = [];
  const here = new URL(address);
  page.on("console", (message) => message.type() === "error" && page.problems.push(message.text()));
  page.on("pageerror", (error) => page.problems.push(error.message));
  page.on("request", (request) => {
    const { protocol, host } = new URL(request.url());
    const own = ["data:", "blob:"].includes(protocol) || (protocol === here.protocol && host === here.host);
    if (!own) page.problems.push(`asks for ${request.url()}`);
  });
  await page.goto(address);
  await page.addScriptTag({ path: fileURLToPath(new URL("../examples/report/painted.js", import.meta.url)) });
  await page.waitForFunction(() => window.labState && window.labState().steps > 0);
  return page;
}
export async function close(page, name) {
  expect(page.problems.length === 0, `${name}: no errors, nothing asked of the network${page.problems.map((p) => `; ${p}`).join("")}`);
  await page.close();
}

export const state = (page) => page.evaluate(() => window.labState());
export const shown = (page, selector) => page.locator(selector).isVisible();
export const text = (page, selector) => page.locator(selector).textContent();
export const choose = (page, name) => page.locator("#methods").getByText(name, { exact: true }).click();
/// Waits until the worker has answered.
export const settled = (page) => page.waitForFunction(() => !window.labState().busy);
export async function scene(page, name) {
  await page.locator("#scenes").getByText(name, { exact: true }).click();
  await page.waitForFunction((wanted) => window.labState().scene === wanted && !window.labState().busy, name);
}

/// Drags the slider's thumb until it stands at h, as a hand does: by what the page then shows.
export async function dragStep(page, h) {
  await page.locator("#h").scrollIntoViewIfNeeded();
  const box = await page.locator("#h").boundingBox();
  const { least, most } = (await state(page)).slider;
  const at = (value) => box.x + 8 + (box.width - 16) * (Math.log(value / least) / Math.log(most / least));
  const y = box.y + box.height / 2;
  await page.mouse.move(at((await state(page)).settings.h), y);
  await page.mouse.down();
  await page.mouse.move(at(h), y, { steps: 5 });
  await page.mouse.up();
  return (await state(page)).settings.h;
}

/// Waits until the cloth has blown up, or for so many steps; the most that particles swung and the
/// farthest that one went meanwhile, in diagonals of the scene.
export async function watch(page, steps, seconds = 60) {
  const from = (await state(page)).steps;
  let swing = 0, far = 0;
  for (const until = Date.now() + 1000 * seconds; Date.now() < until;) {
    const now = await state(page);
    swing = Math.max(swing, now.ringing);
    far = Math.max(far, now.reach);
    if (now.blown || now.steps - from >= steps) break;
    await page.waitForTimeout(50);
  }
  return { swing, far, taken: (await state(page)).steps - from, blown: (await state(page)).blown };
}

/// The share of a canvas that is painted, and in how many colours.
export function paintedView(page, id = "view") {
  return page.evaluate(async (id) => {
    const source = document.getElementById(id);
    await new Promise(requestAnimationFrame);  // what WebGL drew is kept until the frame ends
    const copy = Object.assign(document.createElement("canvas"), { width: source.width, height: source.height });
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    return painted(context.getImageData(0, 0, copy.width, copy.height));
  }, id);
}

export async function checkLayout(page, name) {
  const { share, colours } = await paintedView(page);
  expect(share > 0.015 && colours > 16, `${name}: the mesh covers ${(100 * share).toFixed(0)} % of its picture in ${colours} colours`);
  const [wide, words] = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.querySelector("main").innerText]);
  expect(wide <= 0, `${name}: the page is no wider than the window`);
  expect(!/undefined|NaN|Infinity|null/.test(words), `${name}: every text has its value`);
}
