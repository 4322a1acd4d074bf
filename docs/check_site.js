// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
"use strict";

// Put into a page with a frame by check_site.cmake, with SITE, a folder, and PAGES. Loads one page after the other into
// the frame. No page is wider than it, formulas and tables that are wider scroll by themselves, formulas are
// typeset, and the search of each kind of page finds. What is wrong stands in the title.

const frame = document.querySelector("iframe");
const wrong = [];
const seen = { formulas: 0, tables: 0, scrolling: 0, searches: 0 };
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

async function until(holds, ms) {
  for (let waited = 0; waited < ms; waited += 20) {
    if (holds()) return true;
    await pause(20);
  }
  return false;
}

function open(page) {
  return new Promise((resolve) => {
    frame.onload = () => resolve(frame.contentWindow);
    frame.src = SITE + page;
  });
}

/// Resolves when MathJax has typeset the page; at once where there is no formula.
function typeset(page, view) {
  if (!view.document.querySelector(".formulaInl, .formulaDsp")) return Promise.resolve(true);
  let done = false;
  const ask = () => view.MathJax && view.MathJax.Hub && view.MathJax.Hub.Queue && (view.MathJax.Hub.Queue(() => (done = true)), true);
  return until(ask, 20000).then(() => until(() => done && view.document.querySelector(".MathJax_SVG svg"), 60000));
}

/// Whether the element, or one around it within the page, scrolls what is wider than itself.
function scrolls(element, view) {
  for (let box = element; box && box !== view.document.body && box.id !== "doc-content"; box = box.parentElement) {
    if (/auto|scroll/.test(view.getComputedStyle(box).overflowX)) return true;
  }
  return false;
}

function checkWidth(page, view) {
  const { document } = view;
  const room = view.innerWidth;
  const parts = [document.documentElement, document.body, document.getElementById("doc-content")];
  const wide = Math.max(...parts.map((part) => (part ? part.scrollWidth : 0)));
  if (wide > room) {
    const out = [...document.querySelectorAll("#doc-content *, #top *")].filter((e) => e.getBoundingClientRect().right > room + 1 && !scrolls(e, view));
    const names = [...new Set(out.map((e) => `${e.tagName.toLowerCase()}.${e.getAttribute("class") || e.id}`))].slice(0, 4);
    wrong.push(`${page} is ${wide} px wide: ${names.join(", ")}`);
  }
  for (const kind of ["formulas", "tables"]) {
    for (const element of document.querySelectorAll(kind === "formulas" ? ".MathJax_SVG svg" : ".contents table")) {
      ++seen[kind];
      if (element.getBoundingClientRect().right <= room && element.scrollWidth <= room) continue;
      if (scrolls(element, view)) ++seen.scrolling;
      else wrong.push(`${page}: one of the ${kind} ends at ${Math.round(element.getBoundingClientRect().right)} px and does not scroll`);
    }
  }
}

/// Types into the search field as a reader would.
async function checkSearch(page, view, word) {
  ++seen.searches;
  const { document } = view;
  const field = document.getElementById("MSearchField");
  const menu = document.getElementById("main-menu-state");
  if (field && field.offsetParent === null && menu) menu.click();  // the menu of a phone holds it
  if (!field || !(await until(() => field.offsetParent !== null, 2000))) return wrong.push(`${page}: no field to search in`);
  const { left, right } = field.getBoundingClientRect();
  if (left < 0 || right > view.innerWidth) wrong.push(`${page}: the search field is from ${left} to ${right} px`);
  field.focus();
  field.value = word;
  for (const kind of ["keydown", "keyup"]) field.dispatchEvent(new view.KeyboardEvent(kind, { key: "b", keyCode: 66, bubbles: true }));
  const results = () => {
    const box = document.getElementById("MSearchResults");
    const text = box && box.tagName === "IFRAME" ? box.contentDocument && box.contentDocument.body : box;
    return text && text.innerText.replace(/\s+/g, " ");
  };
  const shown = () => document.getElementById("MSearchResultsWindow").offsetParent !== null || document.getElementById("MSearchResultsWindow").style.display === "block";
  if (!(await until(() => shown() && (results() || "").includes(word), 5000))) wrong.push(`${page}: the search for ${word} says "${(results() || "").slice(0, 80)}"`);
  const box = document.getElementById("MSearchResultsWindow").getBoundingClientRect();
  if (box.left < -1 || box.right > view.innerWidth + 1) wrong.push(`${page}: what the search found is from ${Math.round(box.left)} to ${Math.round(box.right)} px`);
}

async function check() {
  const searched = new Set();
  for (const page of PAGES) {
    const view = await open(page);
    if (!(await typeset(page, view))) wrong.push(`${page}: its formulas are not typeset`);
    await pause(20);
    checkWidth(page, view);
    const kind = page.replace(/_.*|[0-9].*|\.html/g, "");  // index, md, class, struct, ...
    if (searched.has(kind) || !view.document.getElementById("MSearchField")) continue;
    searched.add(kind);
    await checkSearch(page, view, "energy_limit");
  }
  if (searched.size < 3) wrong.push(`${searched.size} kinds of pages alone can be searched`);
  if (seen.formulas < 20 || seen.scrolling < 1) wrong.push(`${seen.formulas} formulas, ${seen.scrolling} things that scroll: too few to be this site`);
  document.title = wrong.length ? `wrong: ${wrong.slice(0, 12).join(" | ")}${wrong.length > 12 ? ` | and ${wrong.length - 12} more` : ""}`
    : `good: ${PAGES.length} pages, ${seen.formulas} formulas, ${seen.tables} tables, of which ${seen.scrolling} scroll, ${seen.searches} searches`;
}
check().catch((error) => (document.title = `wrong: ${error.stack}`));
