/**
 * Sample points of the sun's disc and of hemispheres: the port of render/sample_tables.cpp. The
 * points are those of `voxdag render`, rounded to float.
 */
import { SAMPLES } from '../constants.js';

/** @param {number} v */
function hashBits(v) {
  v ^= v >>> 16;
  v = Math.imul(v, 0x7feb352d);
  v ^= v >>> 15;
  v = Math.imul(v, 0x846ca68b);
  return (v ^ (v >>> 16)) >>> 0;
}

/** @param {number} v */
function reverseBits(v) {
  v = (v << 16) | (v >>> 16);
  v = ((v & 0x00ff00ff) << 8) | ((v & 0xff00ff00) >>> 8);
  v = ((v & 0x0f0f0f0f) << 4) | ((v & 0xf0f0f0f0) >>> 4);
  v = ((v & 0x33333333) << 2) | ((v & 0xcccccccc) >>> 2);
  return ((v & 0x55555555) << 1) | ((v & 0xaaaaaaaa) >>> 1);
}

/** @param {number} v @param {number} seed */
function scramble(v, seed) {
  v = reverseBits(v);
  v ^= Math.imul(v, 0x3d20adea);
  v = (v + seed) | 0;
  v = Math.imul(v, (seed >>> 16) | 1);
  v ^= Math.imul(v, 0x05526c56);
  v ^= Math.imul(v, 0x53a22864);
  return reverseBits(v) >>> 0;
}

/** Returns point `index` of the Sobol sequence in three dimensions. @param {number} index */
function sobol(index) {
  let v1 = 1 << 31, v20 = 1 << 31, v21 = 3 << 30;
  const point = [reverseBits(index), 0, 0];
  for (; index !== 0; index >>>= 1) {
    if (index & 1) {
      point[1] ^= v1;
      point[2] ^= v20;
    }
    v1 ^= v1 >>> 1;
    const next = v21 ^ v20 ^ (v20 >>> 2);
    v20 = v21;
    v21 = next;
  }
  return point;
}

/**
 * Calls body(set, i, u) for all points of all sets; u has three numbers in (0,1).
 * @param {number} count @param {number} seed @param {(set: number, i: number, u: number[]) => void} body
 */
function forEachPoint(count, seed, body) {
  for (let set = 0; set < SAMPLES.sets; ++set) {
    const setSeed = hashBits(seed + set);
    const seeds = [1, 2, 3].map((axis) => hashBits((setSeed + 7919 * axis) | 0));
    for (let i = 0; i < count; ++i)
      body(set, i, sobol(i).map((bits, axis) => ((scramble(bits, seeds[axis]) >>> 8) + 0.5) * 2 ** -24));
  }
}

/** Columns of the table that hold the rotations: unit vectors around the circle. */
const ROTATION_COLUMNS = SAMPLES.rotations / SAMPLES.sets;

/**
 * Returns the table of samples: SAMPLES.sets rows of four numbers in each column. First `hemisphere` rays of ambient occlusion
 * around (0,0,1), direction and reach; then `light` points of the unit disc; then the rotations, one column after another.
 * @param {number} hemisphere  At least 1, per set. @param {number} light
 */
export function sampleTable(hemisphere, light) {
  const width = hemisphere + light + ROTATION_COLUMNS, values = new Float32Array(4 * SAMPLES.sets * width);
  const put = (/** @type {number} */ set, /** @type {number} */ column, /** @type {number[]} */ four) => values.set(four, 4 * (set * width + column));
  forEachPoint(light, 1, (set, i, u) => {
    const r = Math.sqrt(u[0]), angle = 2 * Math.PI * u[1];
    put(set, hemisphere + i, [r * Math.cos(angle), r * Math.sin(angle)]);
  });
  forEachPoint(hemisphere, 2, (set, i, u) => {
    const r = Math.sqrt(u[0]), angle = 2 * Math.PI * u[1];
    put(set, i, [r * Math.cos(angle), r * Math.sin(angle), Math.sqrt(1 - u[0]), 1 - Math.sqrt(u[2])]);
  });
  for (let i = 0; i < SAMPLES.rotations; ++i) {
    const angle = (2 * Math.PI * i) / SAMPLES.rotations;
    put(i % SAMPLES.sets, hemisphere + light + Math.floor(i / SAMPLES.sets), [Math.cos(angle), Math.sin(angle)]);
  }
  return { values, width };
}

/** Returns the place of view sample `i` in its pixel: the R2 sequence around the centre. @param {number} i @returns {[number, number]} */
export function samplePlace(i) {
  return [(0.5 + i * 0.7548776662466927) % 1, (0.5 + i * 0.5698402909980532) % 1];
}
