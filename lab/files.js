// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The files that stand beside the page or, where the page is one file, in it: compressed, in
// window.labFiles.

/// @returns a Response
async function open(name) {
  const packed = window.labFiles?.[name];
  if (!packed) return fetch(name);
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
}

export const bytesOf = async (name) => (await open(name)).arrayBuffer();

/// An address from which a worker can be started.
export async function addressOf(name) {
  if (!window.labFiles) return name;
  return URL.createObjectURL(new Blob([await bytesOf(name)], { type: "text/javascript" }));
}
