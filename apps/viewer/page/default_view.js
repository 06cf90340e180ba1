// A view of a whole scene from outside, above a corner.

import {add, cross, dot, normalized, scale, sub} from './math.js';

/** @typedef {import('./math.js').Vec3} Vec3 */

const FOV = 35, MARGIN = 1.06;

/**
 * @param {{low: Vec3, high: Vec3}} box @param {number} aspect width / height @param {Vec3} [up]
 * @returns {import('./settings.js').Camera}
 */
export function defaultView(box, aspect, up = [0, 1, 0]) {
  const upward = normalized(up, [0, 1, 0]);
  const aside = normalized(cross(upward, Math.abs(upward[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1]));
  const ahead = cross(aside, upward);
  const forward = normalized(add(add(scale(aside, 0.6), scale(ahead, 0.75)), scale(upward, -0.42)));
  const right = normalized(cross(forward, upward)), top = cross(right, forward);
  const middle = scale(add(box.low, box.high), 0.5), half = scale(sub(box.high, box.low), 0.5);
  const tanY = Math.tan((FOV * Math.PI) / 360) / MARGIN, tanX = tanY * Math.max(aspect, 1e-3);
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const c = /** @type {Vec3} */ (half.map((h, a) => ((corner >> a) & 1 ? h : -h)));
    const depth = dot(c, forward);
    distance = Math.max(distance, Math.abs(dot(c, right)) / tanX - depth, Math.abs(dot(c, top)) / tanY - depth);
  }
  if (!(distance > 0)) distance = 1;
  return {eye: add(middle, scale(forward, -distance)), target: middle, up: upward, fov: FOV};
}
