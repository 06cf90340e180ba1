/**
 * Reads the numbers of cells, and their colours and normals (docs/format.md, CIDX, COLR and NRML).
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
