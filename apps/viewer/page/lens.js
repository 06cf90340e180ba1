/** Where points of the scene are in the picture, and which rays its pixels have. */
import { RADIANS, addScaled, cross, dot, normalized, sub } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Camera} Camera
 */

/**
 * Returns the camera's unit vectors and the tangents of half its angles.
 * @param {Camera} camera @param {number} aspect  Width / height.
 */
export function lensOf(camera, aspect) {
  const forward = normalized(sub(camera.target, camera.eye), [0, 0, -1]);
  const right = normalized(cross(forward, camera.up), [1, 0, 0]);
  const tanY = Math.tan(camera.fov * RADIANS / 2);
  return { eye: camera.eye, forward, right, up: cross(right, forward), tanX: tanY * aspect, tanY };
}

/**
 * Returns the unit direction of the ray through a point of the picture, in pixels from the top left.
 * @param {Camera} camera @param {number} x @param {number} y @param {number} width @param {number} height
 * @returns {Vec3}
 */
export function directionThrough(camera, x, y, width, height) {
  const lens = lensOf(camera, width / height);
  const across = addScaled(lens.forward, lens.right, (2 * x / width - 1) * lens.tanX);
  return normalized(addScaled(across, lens.up, (1 - 2 * y / height) * lens.tanY));
}

/**
 * Returns where a point is in the picture, in pixels, and its depth along the view; x and y have no
 * meaning unless the depth is positive.
 * @param {Camera} camera @param {Vec3} point @param {number} width @param {number} height
 */
export function project(camera, point, width, height) {
  const lens = lensOf(camera, width / height);
  const v = sub(point, lens.eye), depth = dot(v, lens.forward);
  return {
    x: (dot(v, lens.right) / (depth * lens.tanX) + 1) * width / 2,
    y: (1 - dot(v, lens.up) / (depth * lens.tanY)) * height / 2,
    depth,
  };
}
