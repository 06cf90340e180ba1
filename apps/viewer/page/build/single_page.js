/** Writes a page that holds a scene: this page is its own template, or the file voxdag.html beside it. */

/** The part of the page that the interface changes, as it was. */
const shell = document.getElementById('container')?.outerHTML ?? '';
/** Bytes that become base64 at once: a multiple of 3. */
const PART = 3 << 20;

/** Returns whether this page is a single file. */
export const isSinglePage = () => document.querySelector('script[type=importmap]') !== null;

/** Returns this page as its file is, without its scene. */
function ownText() {
  const scripts = [...document.querySelectorAll('body > script:not(#scene)')], entry = scripts.find((script) => /** @type {HTMLScriptElement} */ (script).type === 'module');
  const others = scripts.filter((script) => script !== entry).map((script) => script.outerHTML + '\n');
  return `<!doctype html>\n<html lang="en">\n${document.head.outerHTML}\n<body>\n${shell}\n${others.join('')}<script type="text/plain" id="scene"><\/script>\n${entry?.outerHTML}\n</body>\n</html>\n`;
}

async function fetchedText() {
  const response = await fetch(new URL('../voxdag.html', import.meta.url));
  if (!response.ok) throw new Error(`voxdag.html: the server answers ${response.status}`);
  return response.text();
}

/** Returns the page with a scene and the settings that it begins with. @param {Blob} scene @param {string} title @param {string} settings  JSON. @returns {Promise<Blob>} */
export async function pageWith(scene, title, settings) {
  const text = isSinglePage() ? ownText() : await fetchedText();
  const mark = '<script type="text/plain" id="scene">', at = text.lastIndexOf(mark) + mark.length;
  const begin = text.slice(0, at)
    .replace(/<title>[^<]*<\/title>/, () => `<title>${title.replaceAll('&', '&amp;').replaceAll('<', '&lt;')}</title>`)
    .replace(/\n?<script type="application\/json" id="settings">[^<]*<\/script>/, '')
    .replace('</main>', () => `</main>\n<script type="application/json" id="settings">${settings.replaceAll('<', '\\u003c')}<\/script>`);
  const packed = await new Response(scene.stream().pipeThrough(new CompressionStream('gzip'))).blob(), parts = [begin];
  for (let i = 0; i < packed.size; i += PART) parts.push(await base64(packed.slice(i, i + PART)));
  return new Blob([...parts, text.slice(at)], { type: 'text/html' });
}

/** @param {Blob} bytes @returns {Promise<string>} */
const base64 = (bytes) => new Promise((resolve, reject) => {
  const reader = new FileReader();
  reader.onload = () => resolve(String(reader.result).replace(/^[^,]*,/, ''));
  reader.onerror = () => reject(reader.error);
  reader.readAsDataURL(bytes);
});
