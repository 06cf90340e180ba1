/** Text files of the page: shaders, and the parts of the worker's script. */
import { host } from './host.js';

/** Returns the page's folder. A page in a single file has none: new URL() throws there. */
export const root = () => new URL(/* @vite-ignore */ '../', import.meta.url);

/**
 * Returns the text of a file of the page, from the host or else from the page's folder.
 * @param {string} path from the page's folder, such as "gpu/shaders/dag.glsl"
 * @returns {Promise<string>}
 */
export async function loadText(path) {
  const held = await host.text(path);
  if (held !== null) return held;
  const response = await fetch(new URL(path, root()));
  if (!response.ok) throw new Error(`${path}: the server answers ${response.status}`);
  return response.text();
}
