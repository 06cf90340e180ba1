/** The built-in environments: the port of built_in_environment() in render/environment.cpp. Each returns the radiance from a unit vector. */
import { dot, mix3, normalized, scale, addScaled } from './math.js';

/** @typedef {import('./math.js').Vec3} Vec3 */

/** @param {number} low @param {number} high @param {number} x */
function smoothStep(low, high, x) {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}

const SUN = normalized([-0.8, 0.14, -0.55]);
/** Colours of the sunset. @type {Vec3[]} */
const [WARM, BLUE, ROSE] = [[1, 0.46, 0.2], [0.1, 0.17, 0.36], [0.5, 0.34, 0.38]];
/** The lamps of the studio: direction, light, and the cosines at which it begins and is full. @type {[Vec3, Vec3, number, number][]} */
const LAMPS = [
  [normalized([-0.7, 0.65, 0.45]), [5, 4.8, 4.5], 0.86, 0.9],
  [normalized([0.9, 0.25, 0.35]), [0.8, 0.9, 1.1], 0.8, 0.9],
  [normalized([0.25, 0.5, -0.85]), [2.4, 2.5, 2.7], 0.92, 0.95],
];

/** @type {{[name: string]: (d: Vec3) => Vec3}} */
export const BUILT_IN = {
  studio: (d) => LAMPS.reduce((light, [towards, lamp, from, to]) => addScaled(light, lamp, smoothStep(from, to, dot(d, towards))),
    /** @type {Vec3} */ ([0.12, 0.12, 0.125])),
  overcast: (d) => mix3(scale([0.78, 0.86, 0.95], (1 + 2 * Math.max(d[1], 0)) / 3), [0.16, 0.15, 0.14], smoothStep(-0.02, 0.12, -d[1])),
  sunset(d) {
    const near = Math.max(dot(d, SUN), 0), low = 1 - Math.max(d[1], 0);
    let sky = mix3(mix3(ROSE, WARM, near * near), BLUE, 1 - low * low * low);
    sky = addScaled(sky, WARM, 0.8 * near ** 24);
    if (near > 0.9994) sky = addScaled(sky, [1, 0.5, 0.22], 1400);
    return mix3(sky, [0.09, 0.07, 0.065], smoothStep(-0.02, 0.1, -d[1]));
  },
};
