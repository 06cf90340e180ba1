/**
 * Links and images in the text of a note, as Markdown writes them: [text](address), ![text](address), and plain
 * https addresses. Everything else is plain text; no HTML is ever read from a note.
 */

/**
 * A part of a text: plain, a link or an image. `text` is what is read.
 * @typedef {{kind: 'text' | 'link' | 'image', text: string, address: string}} Part
 */

const MARKS = /(!?)\[([^\[\]\n]*)\]\(([^()\s]+)\)|https:\/\/[^\s<>"'()[\]]*[^\s<>"'()[\].,;:!?]/g;

/**
 * Returns the address if a page may use it, else null: https:, an address relative to the page, or, for images, a
 * picture in a data: URL. SVG is left out: it may hold scripts.
 * @param {string} address @param {boolean} isImage
 */
export function safeAddress(address, isImage) {
  if (/[\u0000-\u0020\u007f\\]/.test(address)) return null;
  if (isImage && /^data:image\/(png|jpeg|gif|webp|avif);base64,[A-Za-z0-9+/=]+$/i.test(address)) return address;
  // As a browser reads it. A relative address keeps the host of the page.
  const page = 'https://page.invalid/folder/';
  if (!URL.canParse(address, page)) return null;
  const { protocol, host } = new URL(address, page);
  return protocol === 'https:' && (/^https:\/\/[^/]/i.test(address) || (host === 'page.invalid' && !/^[^/?#]*:/.test(address))) ? address : null;
}

/** Returns the parts of a text in their order. Marks whose address is not safe stay plain text. @param {string} text @returns {Part[]} */
export function partsOf(text) {
  /** @type {Part[]} */
  const parts = [];
  let at = 0;
  const plain = (/** @type {number} */ end) => { if (end > at) parts.push({ kind: 'text', text: text.slice(at, end), address: '' }); };
  for (const match of text.matchAll(MARKS)) {
    const [all, image, label, marked] = match, isImage = image === '!', address = safeAddress(marked ?? all, isImage);
    if (address === null) continue;
    plain(match.index);
    // A picture of another host would tell that host who looks: it becomes a link.
    const shows = isImage && !/^https:/i.test(address);
    parts.push({ kind: shows ? 'image' : 'link', text: label || (marked === undefined ? address.replace(/^https:\/\//i, '') : address), address });
    at = match.index + all.length;
  }
  plain(text.length);
  return parts;
}

/** Returns the text as it is read, without the marks. @param {string} text */
export const plainText = (text) => partsOf(text).map((part) => (part.kind === 'image' ? `[${part.text.slice(0, 40)}]` : part.text)).join('');

/**
 * Breaks a text into lines of at most `most` characters, between words if it can. At most `lines` lines: the last one
 * then ends with "…".
 * @param {string} text @param {number} most @param {number} lines @returns {string[]}
 */
export function wrapped(text, most, lines) {
  /** @type {string[]} */
  const all = [];
  for (const line of text.split('\n')) {
    let rest = Array.from(line.trimEnd());
    while (rest.length > most) {
      const space = rest.slice(0, most + 1).lastIndexOf(' ');
      all.push(rest.slice(0, space > 0 ? space : most).join(''));
      rest = rest.slice(space > 0 ? space + 1 : most);
    }
    all.push(rest.join(''));
    if (all.length > lines) break;
  }
  while (all.length > 1 && all[all.length - 1] === '') all.pop();
  if (all.length <= lines) return all;
  const last = Array.from(all[lines - 1]);
  return [...all.slice(0, lines - 1), last.slice(0, most - 1).join('').trimEnd() + '…'];
}
