/** Boxes along the axes: their corners, edges and faces, and their cuts with planes. */
import { add, addScaled, cross, dot, normalized, scale, sub } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Box} Box
 * @typedef {import('./settings.js').Plane} Plane
 */

/** Returns the middle of a box. @param {Box} box */
export const middleOf = ({ low, high }) => scale(add(low, high), 0.5);

/**
 * Returns a corner of a box: bit 0 is set for high x, bit 1 for high y, bit 2 for high z.
 * @param {Box} box @param {number} bits @returns {Vec3}
 */
export const cornerOf = (box, bits) => [
  (bits & 1 ? box.high : box.low)[0], (bits & 2 ? box.high : box.low)[1], (bits & 4 ? box.high : box.low)[2]];

/** The twelve edges of a box, as corners. */
export const EDGES = [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/**
 * Returns a box with one of its six faces moved: it keeps at least the size `least`.
 * @param {Box} box @param {number} face  2 × axis, and 1 for the high one. @param {number} value
 * @param {number} least @returns {Box}
 */
export function withFace(box, face, value, least) {
  const axis = face >> 1, low = /** @type {Vec3} */ ([...box.low]), high = /** @type {Vec3} */ ([...box.high]);
  if (face & 1) high[axis] = Math.max(value, low[axis] + least);
  else low[axis] = Math.min(value, high[axis] - least);
  return { low, high };
}

/** Returns the coordinate of a face. @param {Box} box @param {number} face */
export const faceValue = (box, face) => (face & 1 ? box.high : box.low)[face >> 1];

/** Returns the middle of a face. @param {Box} box @param {number} face @returns {Vec3} */
export function faceMiddle(box, face) {
  const middle = middleOf(box);
  middle[face >> 1] = faceValue(box, face);
  return middle;
}

/** Returns the lowest and the highest place of a box along a unit vector. @param {Box} box @param {Vec3} unit */
export function rangeAlong(box, unit) {
  const places = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => dot(unit, cornerOf(box, corner)));
  return [Math.min(...places), Math.max(...places)];
}

/**
 * Returns the polygon in which a plane cuts a box.
 * @param {Box} box @param {Plane} plane @returns {Vec3[]}
 */
export function cutPolygon(box, { point, normal }) {
  /** @type {Vec3[]} */
  const corners = [];
  for (const [a, b] of EDGES) {
    const from = cornerOf(box, a), to = cornerOf(box, b);
    const x = dot(normal, sub(from, point)), y = dot(normal, sub(to, point));
    if ((x < 0) !== (y < 0)) corners.push(addScaled(from, sub(to, from), x / (x - y)));
  }
  if (corners.length < 3) return [];
  const middle = scale(corners.reduce(add), 1 / corners.length);
  const u = normalized(sub(corners[0], middle)), n = normalized(normal);
  const v = cross(n, u);
  const angle = (/** @type {Vec3} */ corner) => Math.atan2(dot(sub(corner, middle), v), dot(sub(corner, middle), u));
  return corners.sort((a, b) => angle(a) - angle(b));
}
