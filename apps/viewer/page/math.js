/**
 * Vectors as arrays of three numbers. Functions return new arrays and change no argument.
 * @typedef {[number, number, number]} Vec3
 */

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/** @param {Vec3} a @param {number} s @returns {Vec3} */
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];

/** Returns a + b * s. @param {Vec3} a @param {Vec3} b @param {number} s @returns {Vec3} */
export const addScaled = (a, b, s) => [a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s];

/** @param {Vec3} a @param {Vec3} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @param {Vec3} a @param {Vec3} b @returns {Vec3} */
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** @param {Vec3} a */
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** @param {Vec3} a @param {Vec3} b */
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/**
 * Returns the unit vector along `a`, or `otherwise` if `a` is zero or not finite.
 * @param {Vec3} a @param {Vec3} [otherwise] @returns {Vec3}
 */
export function normalized(a, otherwise = [0, 0, 0]) {
  const size = length(a);
  return size > 0 && size < Infinity ? scale(a, 1 / size) : otherwise;
}

/** Returns a at t = 0, b at t = 1. @param {number} a @param {number} b @param {number} t */
export const mix = (a, b, t) => a + (b - a) * t;

/** @param {Vec3} a @param {Vec3} b @param {number} t @returns {Vec3} */
export const mix3 = (a, b, t) => [mix(a[0], b[0], t), mix(a[1], b[1], t), mix(a[2], b[2], t)];

/** @param {number} x @param {number} low @param {number} high */
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** @param {Vec3} a */
export const isFinite3 = (a) => a.every(Number.isFinite);

export const RADIANS = Math.PI / 180;

/**
 * Turns `v` around the unit vector `axis` by an angle in radians, counterclockwise if the axis
 * points at the viewer (Rodrigues' formula).
 * @param {Vec3} v @param {Vec3} axis @param {number} angle @returns {Vec3}
 */
export function rotated(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  const along = scale(axis, dot(axis, v) * (1 - c));
  return add(add(scale(v, c), scale(cross(axis, v), s)), along);
}

/**
 * Returns the angle in (-π, π] that differs from `angle` by whole turns.
 * @param {number} angle
 */
export function wrapped(angle) {
  const turns = Math.round(angle / (2 * Math.PI));
  const a = angle - turns * 2 * Math.PI;
  return a <= -Math.PI ? a + 2 * Math.PI : a;
}

/**
 * Returns the power of ten that is at most `size` * `fraction`: the step of round numbers.
 * @param {number} size @param {number} fraction
 */
export const stepBelow = (size, fraction) => Math.floor(Math.log10(size * fraction));

/**
 * Rounds to a multiple of 10 ** exponent, as the double whose decimal text is short.
 * @param {number} x @param {number} exponent
 */
export function roundTo(x, exponent) {
  if (exponent <= 0) return Number(x.toFixed(Math.min(-exponent, 100))) + 0;
  const step = 10 ** exponent;
  return Math.round(x / step) * step + 0;
}

/** @param {Vec3} v @param {number} exponent @returns {Vec3} */
export const roundTo3 = (v, exponent) => [
  roundTo(v[0], exponent),
  roundTo(v[1], exponent),
  roundTo(v[2], exponent),
];
