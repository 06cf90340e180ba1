/** Directions as angles above the horizon and around it. */
import { RADIANS, clamp, normalized, roundTo3 } from '../math.js';
import { anglesOf, compassOf, directionOf } from '../hands/pose.js';

/** @typedef {import('../math.js').Vec3} Vec3 */

/** Returns the angles of a direction: degrees clockwise from north, and above the horizon. @param {Vec3} direction @param {Vec3} up */
export function skyAngles(direction, up) {
  const { yaw, pitch } = anglesOf(compassOf(up), normalized(direction));
  return { azimuth: ((yaw / RADIANS) % 360 + 360) % 360, elevation: pitch / RADIANS };
}

/** Returns the unit vector with these angles, rounded. @param {number} azimuth @param {number} elevation  Degrees. @param {Vec3} up @returns {Vec3} */
export const skyDirection = (azimuth, elevation, up) =>
  roundTo3(directionOf(compassOf(up), azimuth * RADIANS, clamp(elevation, -90, 90) * RADIANS), -5);
