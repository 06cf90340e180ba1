/**
 * A camera as a target, two angles and a distance, which gestures turn, move and scale. The angles
 * are those of a frame east, north, up, so that the horizon stays level with any up axis.
 */
import {
  RADIANS, add, addScaled, clamp, cross, dot, isFinite3, length, mix, mix3, normalized, roundTo, roundTo3, scale,
  stepBelow, sub, wrapped,
} from '../math.js';
import { cornerOf, middleOf } from '../box.js';
import { lensOf } from '../lens.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('../settings.js').Box} Box
 * @typedef {{east: Vec3, north: Vec3, up: Vec3}} Compass  Unit vectors.
 *
 * @typedef {object} Pose
 * @property {Compass} compass
 * @property {Vec3} target
 * @property {number} distance  From eye to target.
 * @property {number} yaw  Radians clockwise from north, seen from above.
 * @property {number} pitch  Radians above the horizon.
 * @property {number} fov  Vertical, in degrees.
 */

/** The camera looks at most this steeply, in radians: at the pole it would have no horizon. */
export const STEEPEST = 89.9 * RADIANS;

/**
 * Returns the frame of an up vector. North is the direction in which one looks in the front view:
 * -z if y is up, y if z is up.
 * @param {Vec3} upwards @returns {Compass}
 */
export function compassOf(upwards) {
  const up = normalized(upwards, [0, 1, 0]);
  /** @type {Vec3} */
  const reference = Math.abs(up[2]) > Math.abs(up[1]) ? [0, 1, 0] : [0, 0, -1];
  const north = normalized(addScaled(reference, up, -dot(reference, up)));
  return { east: cross(north, up), north, up };
}

/** Returns the unit vector with these angles. @param {Compass} compass @param {number} yaw @param {number} pitch  Radians. @returns {Vec3} */
export function directionOf(compass, yaw, pitch) {
  const flat = add(scale(compass.north, Math.cos(yaw)), scale(compass.east, Math.sin(yaw)));
  return add(scale(flat, Math.cos(pitch)), scale(compass.up, Math.sin(pitch)));
}

/** Returns the angles of a unit vector, in radians. @param {Compass} compass @param {Vec3} forward */
export function anglesOf(compass, forward) {
  const x = dot(forward, compass.east), y = dot(forward, compass.north);
  return { yaw: Math.hypot(x, y) > 1e-9 ? Math.atan2(x, y) : 0, pitch: Math.asin(clamp(dot(forward, compass.up), -1, 1)) };
}

/** @param {Camera} camera @returns {Pose} */
export function poseOf(camera) {
  const compass = compassOf(camera.up);
  const line = sub(camera.target, camera.eye);
  const { yaw, pitch } = anglesOf(compass, normalized(line, compass.north));
  return {
    compass, target: camera.target, distance: length(line) || 1, yaw, pitch: clamp(pitch, -STEEPEST, STEEPEST),
    fov: camera.fov,
  };
}

/** @param {Pose} pose */
export const forwardOf = (pose) => directionOf(pose.compass, pose.yaw, pose.pitch);

/** @param {Pose} pose */
export const eyeOf = (pose) => addScaled(pose.target, forwardOf(pose), -pose.distance);

/** @param {Pose} pose @returns {Camera} */
export const cameraOf = (pose) =>
  ({ eye: eyeOf(pose), target: pose.target, up: pose.compass.up, fov: pose.fov });

/**
 * Returns the pose with another target and the same eye: turned or at another distance.
 * @param {Pose} pose @param {Vec3} eye @returns {Pose}
 */
export const withEye = (pose, eye) => ({ ...pose, target: addScaled(eye, forwardOf(pose), pose.distance) });

/** @param {Pose} pose */
export const isFinitePose = (pose) =>
  isFinite3(pose.target) && Number.isFinite(pose.yaw + pose.pitch) && pose.distance > 0 && pose.distance < 1e30;

/**
 * Returns the pose that lies the part `t` of the way from `a` to `b`. The fixed point of the motion
 * is the target or the eye. Target and distance are both linear in `t`: so a zoom about a point
 * keeps that point where it is in the picture, all the way.
 * @param {Pose} a @param {Pose} b @param {number} t @param {'target' | 'eye'} pivot @returns {Pose}
 */
export function between(a, b, t, pivot) {
  const pose = {
    ...b,
    target: mix3(a.target, b.target, t),
    distance: mix(a.distance, b.distance, t),
    yaw: b.yaw - wrapped(b.yaw - a.yaw) * (1 - t),
    pitch: mix(a.pitch, b.pitch, t),
    fov: mix(a.fov, b.fov, t),
  };
  return pivot === 'target' ? pose : withEye(pose, mix3(eyeOf(a), eyeOf(b), t));
}

/**
 * Returns about how far apart two poses are in the picture, in heights of the picture.
 * @param {Pose} a @param {Pose} b
 */
export function apart(a, b) {
  const reach = Math.min(a.distance, b.distance) * Math.tan(a.fov * RADIANS / 2) * 2;
  const moved = length(sub(a.target, b.target)) + Math.abs(a.distance - b.distance);
  const turned = Math.abs(wrapped(a.yaw - b.yaw)) + Math.abs(a.pitch - b.pitch);
  return moved / reach + turned / (a.fov * RADIANS) + Math.abs(a.fov - b.fov) / a.fov;
}

/**
 * Rounds a camera to numbers with short texts, by less than a hundredth of a pixel of a 4K picture.
 * @param {Camera} camera @returns {Camera}
 */
export function roundCamera(camera) {
  const step = stepBelow(length(sub(camera.target, camera.eye)), 1e-6);
  const up = roundTo3(camera.up, -9);
  return {
    eye: roundTo3(camera.eye, step),
    target: roundTo3(camera.target, step),
    up: length(up) > 0.5 ? up : camera.up,
    fov: roundTo(camera.fov, -4) || camera.fov,
  };
}

/**
 * Returns the pose with the direction of `pose` in which the box fills the picture except for a margin.
 * @param {Pose} pose @param {Box} box @param {number} aspect  Width / height. @returns {Pose}
 */
export function framed(pose, box, aspect) {
  const size = length(sub(box.high, box.low));
  const middle = middleOf(box);
  if (!(size > 0)) return { ...pose, target: middle };
  const lens = lensOf(cameraOf({ ...pose, target: [0, 0, 0], distance: 1 }), aspect);
  const tanX = lens.tanX / 1.08, tanY = lens.tanY / 1.08;
  // A point (x, y, z) along right, up and forward is in the picture if |x - ex| <= tanX (z - ez)
  // and |y - ey| <= tanY (z - ez): half-spaces, whose farthest corners give the eye.
  let left = -Infinity, right = -Infinity, bottom = -Infinity, top = -Infinity, near = Infinity;
  for (let i = 0; i < 8; ++i) {
    const corner = sub(cornerOf(box, i), middle);
    const x = dot(corner, lens.right), y = dot(corner, lens.up), z = dot(corner, lens.forward);
    right = Math.max(right, x - z * tanX);
    left = Math.max(left, -x - z * tanX);
    top = Math.max(top, y - z * tanY);
    bottom = Math.max(bottom, -y - z * tanY);
    near = Math.min(near, z);
  }
  const x = (right - left) / 2, y = (top - bottom) / 2;
  const z = Math.min(-(right + left) / (2 * tanX), -(top + bottom) / (2 * tanY), near - 0.02 * size);
  const eye = add(middle, add(add(scale(lens.right, x), scale(lens.up, y)), scale(lens.forward, z)));
  return withEye({ ...pose, distance: -z }, eye);
}

/** Returns the camera, moved so that the box fills the picture. @param {Camera} camera @param {Box} box @param {number} aspect */
export const framedCamera = (camera, box, aspect) => cameraOf(framed(poseOf(camera), box, aspect));

/** The named views: yaw and pitch in degrees. @type {{[name: string]: [number, number]}} */
export const VIEWS = {
  front: [0, 0], right: [-90, 0], back: [180, 0], left: [90, 0], top: [0, -90], bottom: [0, 90],
};

/** Returns the pose, turned to a named view. @param {Pose} pose @param {[number, number]} view */
export const turnedTo = (pose, [yaw, pitch]) => ({ ...pose, yaw: yaw * RADIANS, pitch: clamp(pitch * RADIANS, -STEEPEST, STEEPEST) });

/** Yaw, pitch and field of view of the first view, in degrees: from outside, above a corner. */
const HOME = /** @type {[number, number]} */ ([51.3, -23.6]), HOME_FOV = 35;

/**
 * Returns the view that a scene suggests. The home view of its file, if it has one, counts as it is
 * if it is inside the box; else it gives the direction.
 * @param {Box} box @param {number} aspect  Width / height. @param {Vec3} up  Unit vector. @param {Camera | null} [home]
 */
export function homeView(box, aspect, up, home = null) {
  if (home !== null && home.eye.every((x, a) => x > box.low[a] && x < box.high[a])) return home;
  const north = compassOf(up).north;
  const pose = home === null ? turnedTo(poseOf({ eye: [0, 0, 0], target: north, up, fov: HOME_FOV }), HOME) : poseOf(home);
  return cameraOf(framed(pose, box, Math.max(aspect, 1e-3)));
}

/** Returns the unit vector of an axis. @param {'x' | 'y' | 'z'} name @returns {Vec3} */
export const axisNamed = (name) => [name === 'x' ? 1 : 0, name === 'y' ? 1 : 0, name === 'z' ? 1 : 0];
