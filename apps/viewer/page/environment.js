/**
 * The light around a scene from a map of all directions, instead of the clear sky: the port of render/environment.cpp,
 * which explains the method. The map is octahedral; its own axes: y is up, -z its middle.
 */
import { EXPOSURE, LIGHT } from './constants.js';
import { RADIANS, add, cross, dot, length, normalized, scale } from './math.js';
import { BUILT_IN } from './environment_skies.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {{name: string, side: number, texels: string, sun: Vec3, towards: Vec3}} PackedMap  An environment in settings:
 *   texels: base64 of side² times red, green, blue and their exponent, without the sun; sun: its irradiance.
 * @typedef {string | PackedMap} EnvironmentMap  A string names a built-in one.
 * @typedef {{side: number, texels: Float32Array, sun: Vec3, towards: Vec3, harmonics: Vec3[], luminance: number}} Environment
 *   texels: three numbers each, without the sun; towards: the sun, or zero; luminance: the mean, without the sun.
 */

/** Side of the maps of built-in environments, and samples per side of a texel. */
const SIDE = 256, SAMPLES = 4;
/** A sun is brighter than so many times the mean, this near to the brightest place, and gives this part of the rest's light. */
const SUN = { timesMean: 20, cosine: Math.cos(10 * RADIANS), least: 0.1 };

/** @param {ArrayLike<number>} c */
const luminanceOf = (c) => EXPOSURE.luminance[0] * c[0] + EXPOSURE.luminance[1] * c[1] + EXPOSURE.luminance[2] * c[2];

/** Returns the direction at a place of [-1,1]², and the solid angle there per area of the map. @param {number} x @param {number} z @returns {[Vec3, number]} */
function placeAt(x, z) {
  const y = 1 - Math.abs(x) - Math.abs(z);
  const on = /** @type {Vec3} */ (y >= 0 ? [x, y, z] : [Math.sign(x) * (1 - Math.abs(z)), y, Math.sign(z) * (1 - Math.abs(x))]);
  const distance = length(on);
  return [scale(on, 1 / distance), distance ** -3];
}

/** Calls body(direction, its solid angle, the texel's first number) for each texel. @param {number} side @param {(direction: Vec3, angle: number, at: number) => void} body */
function forTexels(side, body) {
  for (let i = 0; i < side * side; ++i) {
    const [direction, density] = placeAt((2 * (i % side) + 1) / side - 1, (2 * Math.floor(i / side) + 1) / side - 1);
    body(direction, density * 4 / side ** 2, 3 * i);
  }
}

/** Returns a map of the means of radiance(direction) over each texel. @param {(direction: Vec3) => Vec3} radiance */
function sampled(radiance) {
  const texels = new Float32Array(3 * SIDE ** 2), fine = SIDE * SAMPLES;
  for (let row = 0; row < fine; ++row)
    for (let column = 0; column < fine; ++column) {
      const light = radiance(placeAt((2 * column + 1) / fine - 1, (2 * row + 1) / fine - 1)[0]);
      const at = 3 * (Math.floor(row / SAMPLES) * SIDE + Math.floor(column / SAMPLES));
      for (let c = 0; c < 3; ++c) texels[at + c] += light[c] / SAMPLES ** 2;
    }
  return texels;
}

/** Takes the sun out of a map. Returns its irradiance and direction; zero if there is none. @param {Float32Array} texels @param {number} side */
function takeSunOut(texels, side) {
  const bright = (/** @type {number} */ at) => luminanceOf(texels.subarray(at, at + 3));
  let sum = 0, most = -1, middle = /** @type {Vec3} */ ([0, 1, 0]);
  forTexels(side, (direction, angle, at) => {
    sum += bright(at) * angle;
    if (bright(at) > most) [most, middle] = [bright(at), direction];
  });
  const limit = SUN.timesMean * sum / (4 * Math.PI);
  /** @param {Vec3} direction @param {number} at */
  const partOfSun = (direction, at) => (bright(at) > limit && dot(direction, middle) >= SUN.cosine ? 1 - limit / bright(at) : 0);
  let sun = /** @type {Vec3} */ ([0, 0, 0]), towards = sun;
  forTexels(side, (direction, angle, at) => {
    const part = partOfSun(direction, at);
    if (part === 0) return;
    const given = scale([texels[at], texels[at + 1], texels[at + 2]], part * angle);
    sun = add(sun, given);
    towards = add(towards, scale(direction, luminanceOf(given)));
  });
  const given = luminanceOf(sun);
  if (given < SUN.least * (sum - given)) return { sun: /** @type {Vec3} */ ([0, 0, 0]), towards: /** @type {Vec3} */ ([0, 0, 0]) };
  forTexels(side, (direction, _, at) => {
    const left = 1 - partOfSun(direction, at);
    if (left < 1) for (let c = 0; c < 3; ++c) texels[at + c] *= left;
  });
  return { sun, towards: normalized(towards) };
}

/** Returns the nine harmonics of what surfaces receive, divided by pi. @param {Float32Array} texels @param {number} side @returns {Vec3[]} */
function harmonicsOf(texels, side) {
  const factors = [1, 2, 2, 2, 15 / 4, 15 / 4, 15 / 4, 15 / 16, 5 / 16].map((x) => x / (4 * Math.PI));
  const sums = factors.map(() => /** @type {Vec3} */ ([0, 0, 0]));
  forTexels(side, ([x, y, z], angle, at) => {
    const values = [1, x, y, z, x * y, y * z, z * x, x * x - y * y, 3 * z * z - 1];
    for (let k = 0; k < 9; ++k) for (let c = 0; c < 3; ++c) sums[k][c] += texels[at + c] * values[k] * angle;
  });
  return sums.map((sum, k) => scale(sum, factors[k]));
}

/** Returns the texels of a packed map. @param {PackedMap} map */
function unpacked({ texels }) {
  const bytes = atob(texels), values = new Float32Array(bytes.length / 4 * 3);
  for (let i = 0; 4 * i < bytes.length; ++i) {
    const unit = 2 ** (bytes.charCodeAt(4 * i + 3) - 136);
    for (let c = 0; c < 3; ++c) values[3 * i + c] = bytes.charCodeAt(4 * i + c) * unit;
  }
  return values;
}

/** The last environments by their maps. @type {Map<EnvironmentMap, Environment>} */
const made = new Map();
const MOST_MADE = 4;

/** Returns the environment of a map of the settings; the same object for the same map. @param {EnvironmentMap | null} map @returns {Environment | null} */
export function environmentOf(map) {
  if (map === null) return null;
  let environment = made.get(map);
  if (environment === undefined) {
    const packed = typeof map === 'string' ? null : map, side = packed?.side ?? SIDE;
    const texels = packed ? unpacked(packed) : sampled(BUILT_IN[/** @type {string} */ (map)]);
    const { sun, towards } = packed ?? takeSunOut(texels, side), harmonics = harmonicsOf(texels, side);
    environment = { side, texels, sun, towards, harmonics, luminance: luminanceOf(harmonics[0]) };
    if (made.size >= MOST_MADE) made.clear();
    made.set(map, environment);
  }
  return environment;
}

/** Returns the map's axes x, y and z in the world. @param {Vec3} up  Unit length. @param {number} turn  Degrees to the left. @returns {[Vec3, Vec3, Vec3]} */
export function mapAxes(up, turn) {
  const front = /** @type {Vec3} */ (Math.abs(up[2]) > 0.9 ? [0, 1, 0] : [0, 0, -1]);
  const right = normalized(cross(front, up), [1, 0, 0]), ahead = cross(up, right);
  const c = Math.cos(turn * RADIANS), s = Math.sin(turn * RADIANS);
  return [add(scale(right, c), scale(ahead, s)), up, add(scale(right, s), scale(ahead, -c))];
}

/** The mean luminance of the clear sky and the ground. */
export const CLEAR_LUMINANCE =
  luminanceOf([0, 1, 2].map((c) => LIGHT.ground[c] + LIGHT.zenith[c] * (1 - LIGHT.horizonInDome) + LIGHT.horizon[c] * LIGHT.horizonInDome)) / 2;
