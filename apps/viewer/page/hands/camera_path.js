/**
 * A moving camera through keys, and the file of `voxdag render --path`. The curves are those of
 * render/film/camera_path.cpp, so that a film shows what was played: centripetal Catmull-Rom curves for eye
 * and target (Yuksel, Schaefer and Keyser 2011), monotone cubics of time (Fritsch and Carlson 1980).
 */
import { add, addScaled, clamp, normalized, rotated, scale, sub } from '../math.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('../settings.js').PathKey} PathKey
 * @typedef {Required<PathKey>} Key
 */

/** Returns the weights of a, b, and of their slopes per `width`. @param {number} s  From 0 to 1. @param {number} width */
function weights(s, width) {
  const s2 = s * s, s3 = s2 * s;
  return [2 * s3 - 3 * s2 + 1, 3 * s2 - 2 * s3, (s3 - 2 * s2 + s) * width, (s3 - s2) * width];
}

/**
 * Returns the monotone cubic through values(i) at keys[i].time.
 * @param {Key[]} keys @param {number} i @param {number} time @param {(k: number) => number} values
 */
function monotoneCubic(keys, i, time, values) {
  const width = (/** @type {number} */ k) => keys[k + 1].time - keys[k].time;
  const secant = (/** @type {number} */ k) => (values(k + 1) - values(k)) / width(k);
  const slope = (/** @type {number} */ k) => {
    if (k === 0) return secant(0);
    if (k + 1 === keys.length) return secant(k - 1);
    const before = secant(k - 1), after = secant(k);
    if (!(before * after > 0)) return 0;
    const w0 = 2 * width(k) + width(k - 1), w1 = width(k) + 2 * width(k - 1);
    return (w0 + w1) / (w0 / before + w1 / after);
  };
  const [a, b, da, db] = weights((time - keys[i].time) / width(i), width(i));
  return values(i) * a + values(i + 1) * b + slope(i) * da + slope(i + 1) * db;
}

/** Returns the eye or the target between keys i and i + 1. @param {Key[]} keys @param {number} i @param {number} time @param {'eye' | 'target'} name @returns {Vec3} */
function alongCurve(keys, i, time, name) {
  const point = (/** @type {number} */ k) => keys[k][name];
  const gap = (/** @type {number} */ k) => Math.max(Math.sqrt(Math.hypot(...sub(point(k + 1), point(k)))), 1e-9);
  const knots = [0];
  for (let k = 0; k + 1 < keys.length; ++k) knots.push(knots[k] + gap(k));
  const secant = (/** @type {number} */ k) => scale(sub(point(k + 1), point(k)), 1 / gap(k));
  const velocity = (/** @type {number} */ k) => {
    if (k === 0) return secant(k);
    if (k + 1 === keys.length) return secant(k - 1);
    const wide = scale(sub(point(k + 1), point(k - 1)), 1 / (gap(k - 1) + gap(k)));
    return add(sub(secant(k - 1), wide), secant(k));
  };
  const knot = monotoneCubic(keys, i, time, (k) => knots[k]);
  const [a, b, da, db] = weights((knot - knots[i]) / gap(i), gap(i));
  return addScaled(addScaled(addScaled(scale(point(i), a), point(i + 1), b), velocity(i), da), velocity(i + 1), db);
}

/**
 * Fills in the values that keys leave out: those of the key before; for the first key those of `first`.
 * @param {PathKey[]} keys @param {Camera} first @returns {Key[]}
 */
export function completeKeys(keys, first) {
  let { up, fov } = first;
  return keys.map((key) => ({ ...key, up: (up = key.up ?? up), fov: (fov = key.fov ?? fov) }));
}

/**
 * Returns the camera at a time: the first key's before it, the last key's after it. The keys' times
 * increase.
 * @param {Key[]} keys @param {number} time @returns {Camera}
 */
export function cameraAt(keys, time) {
  const last = keys.length - 1;
  const cameraOfKey = (/** @type {Key} */ { eye, target, up, fov }) => ({ eye, target, up, fov });
  if (!(time > keys[0].time)) return cameraOfKey(keys[0]);
  if (!(time < keys[last].time)) return cameraOfKey(keys[last]);
  const i = keys.findIndex((key) => key.time > time) - 1;
  const up = (/** @type {number} */ axis) => monotoneCubic(keys, i, time, (k) => keys[k].up[axis]);
  return {
    eye: alongCurve(keys, i, time, 'eye'),
    target: alongCurve(keys, i, time, 'target'),
    up: [up(0), up(1), up(2)],
    fov: monotoneCubic(keys, i, time, (k) => keys[k].fov),
  };
}

/**
 * Returns the keys with one more, `seconds` after the last. Values that the key before has are left
 * out.
 * @param {PathKey[]} keys @param {Camera} camera @param {number} seconds @returns {PathKey[]}
 */
export function withKey(keys, camera, seconds) {
  const before = keys.length ? completeKeys(keys, camera).at(-1) : null;
  /** @type {PathKey} */
  const key = {
    time: before ? Math.round((before.time + seconds) * 1000) / 1000 : 0, eye: camera.eye, target: camera.target,
  };
  if (!before || before.up.join() !== camera.up.join()) key.up = camera.up;
  if (!before || before.fov !== camera.fov) key.fov = camera.fov;
  return [...keys, key];
}

/**
 * Returns the keys without one. The next key keeps the values that it took from the one before it.
 * @param {PathKey[]} keys @param {number} index @returns {PathKey[]}
 */
export function withoutKey(keys, index) {
  const { up, fov } = keys[index], next = keys[index + 1];
  /** @type {PathKey[]} */
  const rest = keys.filter((_, i) => i !== index);
  if (next) rest[index] = { ...(up && { up }), ...(fov !== undefined && { fov }), ...next };
  return rest;
}

/**
 * Returns the keys with one at another time, at least a millisecond after the key before; the later
 * keys keep their distance from it.
 * @param {PathKey[]} keys @param {number} index @param {number} time  Seconds. @returns {PathKey[]}
 */
export function withTime(keys, index, time) {
  const least = index > 0 ? keys[index - 1].time + 0.001 : -Infinity, shift = Math.max(time, least) - keys[index].time;
  return keys.map((key, i) => (i < index ? key : { ...key, time: Math.round((key.time + shift) * 1000) / 1000 }));
}

/**
 * Returns the keys with one at another time, at least a millisecond from its neighbours, which stay.
 * @param {PathKey[]} keys @param {number} index @param {number} time  Seconds. @returns {PathKey[]}
 */
export function withKeyAt(keys, index, time) {
  const low = index > 0 ? keys[index - 1].time + 0.001 : -Infinity, high = keys[index + 1] ? keys[index + 1].time - 0.001 : Infinity;
  return keys.map((key, i) => (i === index ? { ...key, time: Math.round(clamp(time, low, high) * 1000) / 1000 } : key));
}

/** Keys of a turn: their curve leaves the circle by less than a hundredth of its radius. */
const TURN_KEYS = 20;

/**
 * Returns the keys of a whole turn around the camera's target, counterclockwise from above. The last key has the camera of
 * the first.
 * @param {Camera} camera @param {number} seconds @returns {PathKey[]}
 */
export function turntable({ eye, target, up, fov }, seconds) {
  const arm = sub(eye, target), axis = normalized(up, [0, 1, 0]);
  return Array.from({ length: TURN_KEYS + 1 }, (_, i) => ({
    time: Math.round((1000 * seconds * i) / TURN_KEYS) / 1000, target, ...(i === 0 && { up, fov }),
    eye: i === TURN_KEYS ? eye : add(target, rotated(arm, axis, (2 * Math.PI * i) / TURN_KEYS)),
  }));
}

/** Returns the times of a film's frames, from the first key's to the last one's. @param {PathKey[]} keys @param {number} perSecond */
export function frameTimes(keys, perSecond) {
  const begin = keys[0].time, count = Math.floor((keys[keys.length - 1].time - begin) * perSecond + 1e-9) + 1;
  return Array.from({ length: count }, (_, i) => begin + i / perSecond);
}

/**
 * Returns the text of a path file: one line per key, as `voxdag scene --path` prints it.
 * @param {PathKey[]} keys @param {Vec3 | null} [sun]
 */
export function pathToJson(keys, sun = null) {
  const list = (/** @type {Vec3} */ v) => `[${v.join(', ')}]`;
  const lines = keys.map(({ time, eye, target, up, fov }) =>
    `    {"time": ${time}, "eye": ${list(eye)}, "target": ${list(target)}${up ? `, "up": ${list(up)}` : ''}` +
    `${fov === undefined ? '' : `, "fov": ${fov}`}}`);
  return `{\n${sun ? `  "sun": ${list(sun)},\n` : ''}  "keys": [\n${lines.join(',\n')}\n  ]\n}\n`;
}
