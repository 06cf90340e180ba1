/** Directions as angles, and where the sun is if the settings leave it open. */
import { RADIANS, add, clamp, cross, normalized, roundTo3, scale } from '../math.js';
import { anglesOf, compassOf, directionOf, lensOf } from '../hands/pose.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Camera} Camera
 */

/**
 * Returns the unit vector towards the sun; without a direction, over the viewer's left shoulder, as
 * `voxdag render` chooses it.
 * @param {Vec3 | null} direction @param {Camera} camera @returns {Vec3}
 */
export function sunDirection(direction, camera) {
  if (direction) return normalized(direction);
  const up = normalized(camera.up), { right } = lensOf(camera, 1), back = cross(right, up);
  return normalized(add(add(scale(up, 0.9), scale(right, -0.6)), scale(back, 0.25)));
}

/** Returns the angles of a direction: degrees clockwise from north, and above the horizon. @param {Vec3} direction @param {Vec3} up */
export function skyAngles(direction, up) {
  const { yaw, pitch } = anglesOf(compassOf(up), normalized(direction));
  return { azimuth: ((yaw / RADIANS) % 360 + 360) % 360, elevation: pitch / RADIANS };
}

/** @param {number} azimuth @param {number} elevation  Degrees. @param {Vec3} up @returns {Vec3} */
export const skyDirection = (azimuth, elevation, up) =>
  roundTo3(directionOf(compassOf(up), azimuth * RADIANS, clamp(elevation, -90, 90) * RADIANS), -5);
