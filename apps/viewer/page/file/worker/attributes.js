/**
 * Reads the numbers of cells, and their colours, normals and channels (docs/format.md, CIDX, COLR, NRML and CHAN).
 * Part of the worker's script: see scene_loader.js.
 */

/** @param {Uint8Array} bytes @returns {Uint32Array} */
function asWords(bytes) {
  return new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength >> 2);
}

/** @param {Uint8Array} bytes the chunk @param {number} levels */
function parseCellIndex(bytes, levels) {
  const head = CELL_INDEX.headerBytes;
  if (bytes.length < head) throw brokenFile('Chunk CIDX ends inside its header.');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const finest = view.getUint32(CELL_INDEX.finestLevel, true);
  if (finest > levels) throw brokenFile(`Its attributes go down to level ${finest}, but the grid has only ${levels}.`);
  const cells = readSize(view, CELL_INDEX.cells, 'The number of cells in CIDX');
  const width = Array.from(bytes.subarray(CELL_INDEX.width, CELL_INDEX.width + DAG.maxLevels));
  return { finest, cells, width, words: asWords(bytes.slice(head)) };
}

/**
 * Reads the pages of a chunk. Its first number, `precision`, is less than `most`.
 * @param {Uint8Array} bytes the chunk @param {string} id @param {number} cells @param {number} most
 */
function parsePages(bytes, id, cells, most) {
  const head = PAGES.headerBytes;
  if (bytes.length < head) throw brokenFile(`Chunk ${id} ends inside its header.`);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const precision = view.getUint32(PAGES.precision, true);
  const values = readSize(view, PAGES.values, `The number of values in ${id}`), wordCount = readSize(view, PAGES.words, `The number of words in ${id}`);
  if (precision >= most) throw brokenFile(`Chunk ${id} begins with ${precision}; it must be less than ${most}.`);
  if (values !== cells) throw brokenFile(`Chunk ${id} has ${values} values for ${cells} cells.`);
  const pageCount = Math.ceil(values / PAGES.pageValues), groupCount = Math.ceil(pageCount / PAGES.groupPages);
  const wordsAt = head + 8 * groupCount, pagesAt = wordsAt + 8 * wordCount;
  const end = pagesAt + 8 * Math.ceil(pageCount / 4);
  if (end !== bytes.length) throw brokenFile(`Chunk ${id} has ${bytes.length} bytes instead of ${end}.`);
  const begins = new Uint32Array(pageCount);
  for (let page = 0; page < pageCount; ++page) {
    const group = readSize(view, head + 8 * Math.floor(page / PAGES.groupPages), `A group in ${id}`);
    begins[page] = group + view.getUint16(pagesAt + 2 * page, true);
    if (group + 65535 >= 2 ** 32 || begins[page] >= 8 * wordCount) throw brokenFile(`Page ${page} of ${id} begins behind the end of the pages.`);
  }
  return { precision, begins, words: asWords(bytes.slice(wordsAt, pagesAt)) };
}

/** Reads colours or normals. @param {Uint8Array} bytes the chunk @param {string} id @param {number} cells */
const parseValues = (bytes, id, cells) => parsePages(bytes, id, cells, PAGES.channelBits.length);

/** Reads the chunk MTID. @param {Uint8Array} bytes @param {number} cells */
function parseMaterials(bytes, cells) {
  const { precision, ...pages } = parsePages(bytes, 'MTID', cells, 65536);
  return { materials: precision, ...pages };
}

/** Reads the list of the channels (CHAN). @param {BlobSource | ServerSource} source @param {Uint8Array} head @param {Chunk} chunk */
async function readChannelList(source, head, { offset, length }) {
  const { headerBytes, entryBytes, most, kinds } = CHANNELS;
  const bytes = await readPart(source, head, { offset, length: Math.min(length, headerBytes + most * entryBytes) });
  const view = new DataView(bytes.buffer), count = length < headerBytes ? Infinity : view.getUint32(CHANNELS.channels, true);
  if (headerBytes + count * entryBytes > bytes.length) throw brokenFile('Chunk CHAN ends inside its header.');
  const values = readSize(view, CHANNELS.values, 'The number of values in CHAN');
  /** @type {{name: string, kind: string, bound: number, values: number, offset: number, length: number}[]} */
  const list = [];
  let at = offset + headerBytes + count * entryBytes;
  for (let i = 0; i < count; ++i) {
    const entry = headerBytes + i * entryBytes, bound = view.getFloat64(entry + CHANNELS.bound, true), kind = kinds[view.getUint32(entry + CHANNELS.kind, true)];
    const name = /^([\w.-]{1,63})\0/.exec(String.fromCharCode(...bytes.subarray(entry, entry + CHANNELS.nameBytes)))?.[1];
    if (!name || !kind || !(bound >= 0)) throw brokenFile(`Channel ${i} of CHAN has no valid name, kind and bound.`);
    if (list.some((one) => one.name === name)) throw brokenFile(`Chunk CHAN has two channels ${name}.`);
    const size = 8 * readSize(view, entry + CHANNELS.words, `The size of channel ${name}`);
    list.push({ name, kind, bound, values, offset: at, length: size });
    at += size;
  }
  if (at !== offset + length) throw brokenFile(`The channels of CHAN end at byte ${at} instead of ${offset + length}.`);
  return list;
}

/** Decodes a channel: the port of stored/attributes/channels.hpp. @param {Uint32Array} words @param {{name: string, kind: string, bound: number, values: number}} channel @param {number} cells */
function decodeChannel(words, { name, kind, bound, values: count }, cells) {
  const { blockValues } = CHANNELS, packed = 4 * Math.ceil(count / blockValues), isFloat = kind === 'f32';
  if (count !== cells || packed > words.length) throw brokenFile(`Channel ${name} has ${count} values for ${cells} cells.`);
  const values = isFloat ? new Float32Array(count) : new Int32Array(count), codes = new Int32Array(values.buffer);
  for (let i = 0; i < count; ++i) {
    const block = 4 * Math.floor(i / blockValues), flags = words[block + 3], width = flags & 63;
    const bit = (i % blockValues) * width, at = packed + 2 * (words[block] + 2 ** 32 * words[block + 1]) + (bit >> 5), shift = bit & 31;
    if (width > CHANNELS.maxWidth || at + (shift + width) / 32 > words.length) throw brokenFile(`Value ${i} of channel ${name} lies outside of its words.`);
    let above = words[at] >>> shift;
    if (shift + width > 32) above |= words[at + 1] << (32 - shift);
    const number = (words[block + 2] + (width < 32 ? above & ((1 << width) - 1) : above)) | 0;
    if (isFloat && bound > 0 && !(flags & 64)) values[i] = number * (2 * bound);
    else codes[i] = isFloat && number < 0 ? number ^ 0x7fffffff : number;
  }
  let least = Infinity, most = -Infinity;
  for (const x of values) {
    if (x - x !== 0) throw brokenFile(`Channel ${name} has values that are not finite numbers.`);
    if (x < least) least = x;
    if (x > most) most = x;
  }
  const size = 2 ** Number(kind.slice(1)), lowest = kind[0] === 'i' ? -size / 2 : 0;
  if (!isFloat && (least < lowest || most >= lowest + size)) throw brokenFile(`Channel ${name} has values outside of its kind ${kind}.`);
  return { values, range: [least, most] };
}
