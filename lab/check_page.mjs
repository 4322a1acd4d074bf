// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node check_page.mjs site packages pictures [check]
// Uses the page as a reader would, with the mouse, in Chromium without a window, at the width of a
// desk and of a phone, from a server and as one file. Leaves screenshots in `pictures`. Does all
// checks, or the one that is named.

import { statSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { checkCloth } from "./check_cloth.mjs";
import { checkCoarse, checkCoarseCleared } from "./check_coarse.mjs";
import { checkFigure, checkWalk } from "./check_figure.mjs";
import { checkFiles, checkLarge, checkPins, checkReset, checkSkirt } from "./check_mesh.mjs";
import { close, conclude, expect, launch, open, serve, state } from "./check_tools.mjs";

const [site, packages, pictures] = process.argv.slice(2, 5).map((path) => resolve(path));
const only = process.argv[5];
const server = await serve(site);
const browser = await launch(packages);
const DESK = [1280, 800], PHONE = [390, 844];
const single = pathToFileURL(`${site}.html`).href;

/// What one looks at while dragging the step is in the window, without scrolling.
async function checkFold(page, name) {
  for (const id of ["view", "h", "scale", "h-value", "standing", "sentence"]) {
    const box = await page.locator(`#${id}`).boundingBox();
    expect(box && box.y >= 0 && box.y + box.height <= DESK[1] && box.x >= 0 && box.x + box.width <= DESK[0], `${name}: #${id} is above the fold, ${Math.round(box?.y)} to ${Math.round(box?.y + box?.height)} px`);
  }
}
/// On a phone the slider comes right below the cloth.
async function checkOrder(page, name) {
  const [view, track] = [await page.locator("#view").boundingBox(), await page.locator("#h").boundingBox()];
  expect(track.y - view.y - view.height < 120 && track.y > view.y + view.height, `${name}: the slider stands ${Math.round(track.y - view.y - view.height)} px below the cloth`);
}

/// Loads of the page name the same cheapest integrator, or say that it is too close to call.
async function checkAdvice(loads) {
  const winners = [];
  for (let i = 0; i < loads; ++i) {
    const page = await open(browser, server.address, 640, 600);
    await page.waitForFunction(() => window.labState().plans.length > 0);
    const { close, best, second } = (await state(page)).advice;
    winners.push(close ? "too close" : `${await page.locator("#pick").textContent()} (by ${(second.cost / best.cost).toFixed(1)})`);
    await page.close();
  }
  console.log(`     ${winners.join("; ")}`);
  const named = new Set(winners.filter((words) => words !== "too close").map((words) => words.replace(/ \(by.*/, "")));
  expect(named.size <= 1, `advice: ${loads} loads recommend ${[...named].join(" and ") || "nothing"}${winners.includes("too close") ? ", or find it too close to call" : ""}`);
}

const CHECKS = {
  async desktop() {
    const page = await open(browser, server.address, ...DESK);
    await checkFold(page, "desktop");
    await checkCloth(page, "desktop", pictures);
    await close(page, "desktop");
  },
  async phone() {
    const page = await open(browser, server.address, ...PHONE, { deviceScaleFactor: 2 });
    await checkOrder(page, "phone");
    await checkCloth(page, "phone", pictures);
    await close(page, "phone");
  },
  async skirt() {
    const page = await open(browser, server.address, ...DESK);
    await checkSkirt(page, "skirt", pictures);
    await close(page, "skirt");
  },
  async figure() {
    const page = await open(browser, server.address, ...DESK);
    await checkFigure(page, "figure", pictures);
    await close(page, "figure");
    const phone = await open(browser, single, ...PHONE, { deviceScaleFactor: 2, colorScheme: "dark" });
    await checkWalk(phone, "figure_phone", pictures, 4);
    await close(phone, "figure_phone");
  },
  async meshes() {
    const page = await open(browser, server.address, ...DESK);
    await checkFiles(page, "file");
    await checkPins(page, "pins");
    await checkReset(page, "reset");
    await checkLarge(page, "large");
    await close(page, "meshes");
  },
  async coarse() {
    const page = await open(browser, server.address, ...DESK);
    await checkCoarse(page, "coarse", pictures);
    await checkCoarseCleared(page, "coarse");
    await close(page, "coarse");
    const phone = await open(browser, single, ...PHONE, { deviceScaleFactor: 2, colorScheme: "dark" });
    await checkCoarse(phone, "coarse_phone", pictures);
    await close(phone, "coarse_phone");
  },
  async single() {
    const bytes = statSync(`${site}.html`).size;
    expect(bytes <= 1.5e6, `single file: ${(bytes / 1e6).toFixed(2)} MB, at most 1.5 are allowed`);
    const page = await open(browser, single, ...PHONE);
    await checkSkirt(page, "single", pictures);
    await close(page, "single");
  },
  advice: () => checkAdvice(9),
};

try {
  if (only && !(only in CHECKS)) throw new Error(`no check is named ${only}; there are ${Object.keys(CHECKS).join(", ")}`);
  for (const [name, check] of Object.entries(CHECKS)) {
    if (only && only !== name) continue;
    const begin = Date.now();
    await check();
    console.log(`     ${name} took ${((Date.now() - begin) / 1000).toFixed(0)} s`);
  }
} finally {
  await browser.close();
  server.stop();
}
conclude();
