/** A view of a whole scene from outside, above a corner. */
import { cameraOf, framed, poseOf } from './hands/pose.js';
import { add, cross, normalized, scale } from './math.js';

/** @typedef {import('./math.js').Vec3} Vec3 */

const FOV = 35;

/**
 * @param {{low: Vec3, high: Vec3}} box @param {number} aspect width / height @param {Vec3} [up]
 * @returns {import('./settings.js').Camera}
 */
export function defaultView(box, aspect, up = [0, 1, 0]) {
  const upward = normalized(up, [0, 1, 0]);
  const aside = normalized(cross(upward, Math.abs(upward[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1]));
  const forward = add(add(scale(aside, 0.6), scale(cross(aside, upward), 0.75)), scale(upward, -0.42));
  return cameraOf(framed(poseOf({ eye: [0, 0, 0], target: forward, up: upward, fov: FOV }), box, Math.max(aspect, 1e-3)));
}
