/** The part of a ray that a section leaves visible. */
import { addScaled, dot, length, sub } from './math.js';

/** @typedef {import('./math.js').Vec3} Vec3 */

/**
 * Returns where a ray enters and leaves the part that the section keeps, in units of the direction;
 * null if the ray misses it.
 * @param {import('./settings.js').Settings['section']} section @param {Vec3} origin @param {Vec3} direction
 * @param {number} most  The end of the ray.
 * @returns {[number, number] | null}
 */
export function partInSection({ box, plane }, origin, direction, most) {
  let near = 0, far = most;
  // The kept part lies below each face: height + t * rise <= 0.
  const below = (/** @type {number} */ height, /** @type {number} */ rise) => {
    if (rise > 0) far = Math.min(far, -height / rise);
    else if (rise < 0) near = Math.max(near, -height / rise);
    else if (height > 0) far = -Infinity;
  };
  for (let axis = 0; box && axis < 3; ++axis) {
    below(box.low[axis] - origin[axis], -direction[axis]);
    below(origin[axis] - box.high[axis], direction[axis]);
  }
  if (plane) below(dot(plane.normal, sub(origin, plane.point)), dot(plane.normal, direction));
  return near <= far ? [near, far] : null;
}

/** Returns whether a section keeps a point. Points so little outside count as kept. @param {import('./settings.js').Settings['section']} section @param {Vec3} point @param {number} slack */
export const keeps = ({ box, plane }, point, slack) =>
  !(box && point.some((x, axis) => x < box.low[axis] - slack || x > box.high[axis] + slack)) &&
  !(plane && dot(plane.normal, sub(point, plane.point)) > slack * length(plane.normal));

/**
 * Casts a ray at the part of the scene that the section keeps.
 * @template {{distance: number}} H
 * @param {import('./settings.js').Settings['section']} section @param {Vec3} origin @param {Vec3} direction
 * @param {number} most @param {(origin: Vec3, direction: Vec3, most: number) => H | null} cast
 * @returns {H | null}
 */
export function castInSection(section, origin, direction, most, cast) {
  const part = partInSection(section, origin, direction, most);
  if (!part) return null;
  const [near, far] = part, hit = cast(near > 0 ? addScaled(origin, direction, near) : origin, direction, far - near);
  return hit && { ...hit, distance: hit.distance + near };
}
