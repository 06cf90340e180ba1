/** The scene that a page holds itself: base64 of a gzip of the file. */

/** @returns {Promise<ArrayBuffer | null>} the bytes of the file, or null if the page holds none */
export async function inlineScene() {
  const element = document.querySelector('script[type="text/plain"]#scene');
  if (element === null) return null;
  const text = (element.textContent ?? '').trim();
  const response = await fetch(`data:application/octet-stream;base64,${text}`).catch(() => null);
  const packed = response === null ? decodeBase64(text) : response.body;
  if (packed === null) throw new Error('the page holds no scene');
  const stream = packed instanceof Uint8Array ? new Blob([/** @type {BlobPart} */ (packed)]).stream() : packed;
  element.remove();
  return new Response(stream.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

/** @param {string} text @returns {Uint8Array} */
function decodeBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}
