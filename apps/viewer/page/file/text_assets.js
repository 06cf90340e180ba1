/** Text files of the page: shaders, and the parts of the worker's script. */

/** Returns the page's folder. A page in a single file has none: new URL() throws there. */
export const root = () => new URL('../', import.meta.url);

/**
 * Returns the text of a file of the page. A page in a single file holds it in
 * <script type="text/plain" data-path="...">; other pages fetch it.
 * @param {string} path from the page's folder, such as "gpu/shaders/dag.glsl"
 * @returns {Promise<string>}
 */
export async function loadText(path) {
  const inline = document.querySelector(`script[type="text/plain"][data-path="${path}"]`);
  if (inline !== null) return inline.textContent ?? '';
  const response = await fetch(new URL(path, root()));
  if (!response.ok) throw new Error(`${path}: the server answers ${response.status}`);
  return response.text();
}
