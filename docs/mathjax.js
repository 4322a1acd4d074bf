// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

MathJax.Hub.Config({
  messageStyle: "none",
  showMathMenu: false,
  SVG: {font: "TeX", linebreaks: {automatic: true}, scale: 95},
  TeX: {Macros: {T: "^{\\mathsf T}"}}
});
