// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// node build_site.mjs lab.wasm packages site
// Bundles the page into the folder `site`, and into one file `site`.html, in which whatever the page
// would ask a server for stands compressed.

import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";

const [wasm, packages, site] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const { buildSync } = await import(pathToFileURL(`${packages}/node_modules/esbuild/lib/main.js`));

function bundle(file, format) {
  const { outputFiles } = buildSync({
    entryPoints: [`${here}/${file}`], format, bundle: true, minify: true, write: false, target: "es2022", charset: "utf8",
    nodePaths: [`${packages}/node_modules`], legalComments: "none",
  });
  return outputFiles[0].text;
}
const report = `${here}/../examples/report`;
const read = (path) => readFileSync(path, "utf8");
const page = read(`${here}/index.html`);
const style = read(`${report}/style.css`) + read(`${here}/lab.css`);
const script = bundle("main.js", "esm");
const draw = read(`${report}/draw.js`);
const licence = read(`${packages}/node_modules/three/LICENSE`);
const needed = {  // what files.js asks for
  "worker.js": bundle("worker.js", "iife"),
  "lab.wasm": readFileSync(wasm),
  "skirt.obj": readFileSync(`${here}/../examples/data/skirt.obj`),
};

mkdirSync(site, { recursive: true });
for (const [name, text] of Object.entries({ "index.html": page, "lab.css": style, "lab.js": script, "draw.js": draw, "three-LICENSE.txt": licence, ...needed })) writeFileSync(`${site}/${name}`, text);

/// What stands between the tags of a script must not end it.
const inside = (text) => text.replaceAll("</script", "<\\/script");
function put(html, what, by) {
  if (html.split(what).length !== 2) throw new Error(`index.html: ${what} must stand in it once`);
  return html.replace(what, () => by);
}
const packed = Object.fromEntries(Object.entries(needed).map(([name, bytes]) => [name, gzipSync(bytes, { level: 9 }).toString("base64")]));
let single = put(page, '<link rel="stylesheet" href="lab.css">', `<style>\n${style}</style>`);
single = put(single, '<script src="draw.js"></script>', `<script>\n${inside(draw)}</script>\n<script>window.labFiles = ${JSON.stringify(packed)};</script>`);
single = put(single, '<script type="module" src="lab.js"></script>', `<!-- three.js:\n${licence.replaceAll("--", "—")}-->\n<script type="module">\n${inside(script)}</script>`);
writeFileSync(`${site}.html`, single);

const size = (path) => `${(statSync(path).size / 1e6).toFixed(2)} MB`;
console.log(`lab: ${site}.html has ${size(`${site}.html`)}, lab.wasm ${size(wasm)}, lab.js ${size(`${site}/lab.js`)}`);
