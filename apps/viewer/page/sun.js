/** Where the sun is. */
import { lensOf } from './lens.js';
import { addScaled, cross, normalized, scale } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Camera} Camera
 */

/**
 * Returns the sun of an interior, if the scene is one and the camera is in it; else null.
 * @param {{bounds: import('./settings.js').Box, home: (Camera & {sun?: Vec3}) | null}} scene @param {Camera} camera
 */
export const interiorSun = ({ bounds, home }, camera) =>
  (home?.sun && camera.eye.every((x, a) => x > bounds.low[a] && x < bounds.high[a]) ? home.sun : null);

/**
 * Returns the unit vector towards the sun. Without a direction the sun turns with the camera, as
 * `voxdag render` chooses it: `usual` counts along right, up and backward.
 * @param {Vec3 | null} direction @param {Camera} camera @param {readonly number[]} usual @returns {Vec3}
 */
export function sunDirection(direction, camera, usual) {
  if (direction) return normalized(direction, [0, 1, 0]);
  const up = normalized(camera.up, [0, 1, 0]), { right } = lensOf(camera, 1);
  return normalized(addScaled(addScaled(scale(right, usual[0]), up, usual[1]), cross(right, up), usual[2]));
}
