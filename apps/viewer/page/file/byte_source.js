/** Bytes that a page holds itself, as base64 of a gzip: its scene, and the program that builds. */
import { host } from './host.js';
import { root } from './text_assets.js';

/** Texts of fewer characters are decoded here: fetch() is faster, but some pages may not fetch data: addresses. */
const SHORT = 1 << 23;

/** The element of the scene. */
const sceneElement = () => document.querySelector('script[type="text/plain"]#scene');

/** Returns whether the page says that it has no scene: it begins with the start page. */
export const hasNoScene = () => sceneElement()?.textContent?.trim() === '';

/** @returns {Promise<Blob | null>} the file, or null if the page holds none */
export async function inlineScene() {
  const element = sceneElement();
  if (element === null) return null;
  const scene = await unpacked(await packedText(element.textContent ?? '')).blob();
  element.remove();
  return scene;
}

/** Returns a file of the page that is a gzip, unpacked. @param {string} path @returns {Promise<ArrayBuffer>} */
export async function packedFile(path) {
  const held = await host.text(path);
  if (held !== null) return unpacked(await packedText(held)).arrayBuffer();
  const response = await fetch(new URL(path, root()));
  if (!response.ok) throw new Error(`${path}: the server answers ${response.status}`);
  const file = await response.blob(), start = new Uint8Array(await file.slice(0, 2).arrayBuffer());
  // Some servers unpack it for the browser.
  return start[0] === 0x1f && start[1] === 0x8b ? unpacked(file.stream()).arrayBuffer() : file.arrayBuffer();
}

/** @param {ReadableStream} stream */
const unpacked = (stream) => new Response(stream.pipeThrough(new DecompressionStream('gzip')));

/** Decodes base64. @param {string} text @returns {Promise<ReadableStream>} */
async function packedText(text) {
  text = text.trim();
  const response = text.length < SHORT ? null : await fetch(`data:application/octet-stream;base64,${text}`).catch(() => null);
  return response?.body ?? new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))]).stream();
}
