/**
 * The materials of cells in memory: which one a cell has, and how many cells each has. The port of
 * stored/attributes/cell_index_lookup.hpp and material_ids.hpp.
 */
import { bitCount, childMask, childOf } from './trace.js';

/**
 * @typedef {import('./trace.js').Dag} Dag
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./file/scene_loader.js').Attributes} Attributes
 * @typedef {{materials: number, begins: Uint32Array, words: Uint32Array}} MaterialPages
 * @typedef {Attributes['index'] & {levelBegin: number[], slotBegin: number[]}} CellIndex
 */

/** Cells of a page, as everywhere in a file. */
const PAGE_CELLS = 256;
/** Cells from which on nobody waits for their number. */
const MOST_COUNTED = 1e8;

/** Returns the bits of an id. @param {number} materials */
export const idBits = (materials) => Math.ceil(Math.log2(Math.max(1, materials)));

/** Returns at most 24 bits from bit `at`. @param {Uint32Array} words @param {number} at @param {number} count */
function bitsAt(words, at, count) {
  if (count === 0) return 0;
  const word = Math.floor(at / 32), bit = at % 32;
  const low = words[word] >>> bit, high = bit === 0 ? 0 : (words[word + 1] ?? 0) << (32 - bit);
  return ((low | high) >>> 0) % 2 ** count;
}

/**
 * Reads the run at a bit: its id, its length (Infinity for the last of a page) and its size in bits.
 * @param {MaterialPages} pages @param {number} at
 */
function runAt({ words, materials }, at) {
  const bits = idBits(materials), id = bitsAt(words, at, bits);
  if (bitsAt(words, at + bits, 1) === 1) return { id, length: Infinity, bits: bits + 1 };
  const below = bitsAt(words, at + bits + 1, 3);
  return { id, length: 2 ** below + bitsAt(words, at + bits + 4, below), bits: bits + 4 + below };
}

/** Returns the material of the cell with a number. @param {MaterialPages} pages @param {number} number */
export function materialOf(pages, number) {
  let at = 8 * pages.begins[Math.floor(number / PAGE_CELLS)], left = number % PAGE_CELLS;
  for (;;) {
    const run = runAt(pages, at);
    if (left < run.length) return run.id;
    left -= run.length;
    at += run.bits;
  }
}

/** Returns the index with the places of its levels. @param {Attributes['index']} index @param {number[]} levelBegin  Words of NODE. @returns {CellIndex} */
export function withPlaces(index, levelBegin) {
  const slotBegin = [];
  let at = 0;
  for (let level = 0; level + 1 < levelBegin.length; ++level) {
    slotBegin.push(at);
    at += 2 * Math.ceil(((levelBegin[level + 1] - levelBegin[level]) * index.width[level]) / 64);
  }
  return { ...index, levelBegin, slotBegin };
}

/** Returns the number, counted from the node, of the child behind word `word` of a node of `level`. @param {CellIndex} index @param {number} level @param {number} word */
function cellSum({ width, words, levelBegin, slotBegin }, level, word) {
  const count = width[level], at = 32 * slotBegin[level] + (word - levelBegin[level]) * count;
  if (count <= 24) return bitsAt(words, at, count);
  return bitsAt(words, at, 16) + 65536 * bitsAt(words, at + 16, count - 16);
}

/**
 * Returns the value that edits gave to a cell, or null: the port of stored/attributes/value_overlay.hpp.
 * @param {Uint32Array} words @param {number} root @param {Vec3} voxel  A voxel of the cell. @param {number} level @param {number} levels
 * @param {boolean} isNew  Whether the file has no such cell: then values of parts of the cell stand for it.
 */
export function overlayAt(words, root, voxel, level, levels, isNew) {
  const isWords = () => root !== 0 && root < 2 ** 31;
  for (let l = 0; l < level && isWords(); ++l) root = words[8 * root + voxel.reduce((sum, v, a) => sum | (((v >>> (levels - 1 - l)) & 1) << a), 0)];
  while (isNew && isWords()) root = words.subarray(8 * root, 8 * root + 8).find((child) => child !== 0) ?? 0;
  return root < 2 ** 31 ? null : root - 2 ** 31;
}

/**
 * Returns the number of a cell of the file, or -1; a cell finer than the finest with attributes has that of its ancestor.
 * @param {Dag} dag @param {CellIndex} index @param {Vec3} voxel  A voxel of the cell. @param {number} level
 */
export function cellNumber(dag, index, voxel, level) {
  const last = Math.min(level, index.finest);
  let node = 0, number = 0;
  for (let l = 0; l < last; ++l) {
    const shift = dag.levels - 1 - l, child = voxel.reduce((sum, v, a) => sum | (((v >>> shift) & 1) << a), 0);
    const mask = childMask(dag, node, l), before = bitCount(mask & ((1 << child) - 1));
    if (!((mask >> child) & 1)) return -1;
    if (l + 1 < index.finest && l < dag.levels - 2 && before > 0) number += cellSum(index, l, node + before);
    else number += 1 + (l + 1 >= index.finest ? before : 0);  // The finest cells have none below them.
    if (l + 1 < index.finest && l === dag.levels - 2) for (let i = 0; i < child; ++i) if ((mask >> i) & 1) number += 1 + bitCount(childOf(dag, node, l, i));
    node = childOf(dag, node, l, child);
  }
  return number;
}

/**
 * Returns how many cells of the finest level with attributes each material has, or null if there are too many cells to count.
 * All levels must have arrived.
 * @param {Dag} dag @param {{finest: number, cells: number}} index @param {MaterialPages} pages @returns {number[] | null}
 */
export function countMaterials(dag, { finest, cells }, pages) {
  if (cells > MOST_COUNTED) return null;
  const counts = Array(pages.materials).fill(0);
  let number = 0, at = 0, run = { id: 0, length: 0, bits: 0 };
  /** @param {number} node @param {number} level */
  const visit = (node, level) => {
    if (number % PAGE_CELLS === 0) {
      at = 8 * pages.begins[number / PAGE_CELLS];
      run.length = 0;
    }
    if (run.length === 0) {
      run = runAt(pages, at);
      at += run.bits;
    }
    --run.length;
    ++number;
    if (level === finest) return void ++counts[run.id];
    const mask = childMask(dag, node, level);
    for (let i = 0; i < 8; ++i) if ((mask >> i) & 1) visit(level + 1 < finest ? childOf(dag, node, level, i) : 0, level + 1);
  };
  visit(0, 0);
  return counts;
}
