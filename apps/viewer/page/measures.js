/** Values of measures, and the units of lengths. */
import { addScaled, cross, distance, dot, length, sub } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Measure} Measure
 * @typedef {import('./settings.js').Unit} Unit
 */

/** Metres. @type {{[unit in Unit]: number}} */
export const METRES = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254, ft: 0.3048 };

/** Returns the factor from lengths in one unit to lengths in another; 1 if one is not known. @param {Unit | null} from @param {Unit | null} to */
export const unitFactor = (from, to) => (from && to ? METRES[from] / METRES[to] : 1);

/** Returns the length of the line through points. @param {Vec3[]} points @param {boolean} [closed] */
export const pathLength = (points, closed = false) =>
  points.reduce((sum, point, i) => sum + (i > 0 || closed ? distance(point, points.at(i - 1) ?? point) : 0), 0);

/** Returns the area of a polygon. If its corners are not in a plane, that of its projection along its mean normal. @param {Vec3[]} points */
export function polygonArea(points) {
  /** @type {Vec3} */
  let sum = [0, 0, 0];
  for (let i = 2; i < points.length; ++i)
    sum = addScaled(sum, cross(sub(points[i - 1], points[0]), sub(points[i], points[0])), 0.5);
  return length(sum);
}

/** Returns the angle at the middle of three points, in degrees from 0 to 180. @param {Vec3[]} points */
export function angleAt([from, corner, to]) {
  const a = sub(from, corner), b = sub(to, corner);
  return Math.atan2(length(cross(a, b)), dot(a, b)) * 180 / Math.PI;
}

/** Returns the height of a point above another. @param {Vec3[]} points @param {Vec3} up  Unit vector. */
export const heightOf = ([low, high], up) => Math.abs(dot(sub(high, low), up));

/**
 * Returns the value of a measure: an area in square units of the scene, an angle in degrees, a length else.
 * @param {Measure} measure @param {Vec3} up  Unit vector.
 */
export function valueOf({ kind, points }, up) {
  if (kind === 'area') return polygonArea(points);
  if (kind === 'angle') return points.length < 3 ? 0 : angleAt(points);
  return kind === 'height' ? heightOf(points, up) : pathLength(points);
}

/** Returns the point on the axis through `from` that is next to `to`: the axis along which they are farthest apart. @param {Vec3} from @param {Vec3} to @returns {Vec3} */
export function alongAxis(from, to) {
  const way = sub(to, from).map(Math.abs), axis = way.indexOf(Math.max(...way));
  return /** @type {Vec3} */ (from.map((x, i) => (i === axis ? to[i] : x)));
}

/** Returns the largest of 1, 2 and 5 times a power of ten that is at most `x`. @param {number} x */
export function roundBelow(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return ([5, 2].find((digit) => digit * power <= x * (1 + 1e-12)) ?? 1) * power;
}
