/** Files on this computer: a .vdag, or a page that holds one. Part of the worker's script: see scene_loader.js. */

/** Characters of base64 that are decoded at once: a multiple of 4. */
const BASE64_PART = 1 << 20;

/** A file that is read in parts. */
class BlobSource {
  /** @param {Blob} blob */
  constructor(blob) {
    this.blob = blob;
    this.size = blob.size;
  }
  /** Fills `target` from `offset`. @param {Uint8Array} target @param {number} offset */
  async read(target, offset) {
    const end = offset + target.length;
    if (end > this.size) throw brokenFile(`The file ends at byte ${this.size}, but its contents go on to byte ${end}.`);
    let bytes;
    try {
      bytes = await this.blob.slice(offset, end).arrayBuffer();
    } catch {
      throw new SceneError('The file cannot be read', 'It was changed or deleted after the page had opened it. Open it again.');
    }
    target.set(new Uint8Array(bytes));
  }
}

/** Returns the text of the last element with an id that has nothing but text; null without one. @param {string} html @param {string} id */
function textOfElement(html, id) {
  const begin = ` id="${id}">`, at = html.lastIndexOf(begin);
  return at < 0 ? null : html.slice(at + begin.length, html.indexOf('<', at));
}

/** Returns the scene that a page holds: base64 of a gzip. @param {string} html @returns {Promise<Blob>} */
async function sceneOfPage(html) {
  const text = textOfElement(html, 'scene')?.trim();
  if (text === undefined)
    throw new SceneError('This page holds no scene', 'The page opens those that `voxdag export scene.vdag -o scene.html` wrote.');
  try {
    const parts = [];
    for (let at = 0; at < text.length; at += BASE64_PART)
      parts.push(Uint8Array.from(atob(text.slice(at, at + BASE64_PART)), (c) => c.charCodeAt(0)));
    // A Response would do, but Firefox reports its broken stream on the console.
    const reader = new Blob(parts).stream().pipeThrough(new DecompressionStream('gzip')).getReader(), unpacked = [];
    for (let read = await reader.read(); !read.done; read = await reader.read()) unpacked.push(read.value);
    return new Blob(unpacked);
  } catch {
    throw new SceneError('This page is damaged', 'Its scene cannot be decompressed: the page was cut off or changed.');
  }
}

/**
 * Returns the scene of a file, and the settings that a page was made with, as JSON.
 * @param {Blob} file @returns {Promise<{source: BlobSource, settings: string | null}>}
 */
async function openBlob(file) {
  const start = new Uint8Array(await file.slice(0, 64).arrayBuffer());
  if (/^\s*<(!doctype\s+html|html)/i.test(new TextDecoder('latin1').decode(start))) {
    const html = await file.text();
    return { source: new BlobSource(await sceneOfPage(html)), settings: textOfElement(html, 'settings') };
  }
  if (!FILE.magic.every((byte, i) => start[i] === byte))
    throw new SceneError('This file is of another kind', 'The page opens .vdag files, pages with a scene (.html), settings and camera paths (.json).');
  return { source: new BlobSource(file), settings: null };
}
