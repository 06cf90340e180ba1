/** The colour scales of pictures of the structure and of channels: which values have which colours. */

/** @typedef {import('../settings.js').Show} Show */

/** The steps that are shown brightest, and how many levels differ in colour. */
const BRIGHTEST_STEPS = 160, SHOWN_LEVELS = 7;

/**
 * Returns the values that are shown darkest and brightest: levels, steps, or binary logarithms of
 * how often a node is used. Null if the view has no such scale.
 * @param {Show} show @param {number} levels  Of the scene. @param {number} mostInstances
 * @returns {[number, number] | null}
 */
export function shownRange(show, levels, mostInstances) {
  if (show === 'level') return [Math.max(0, levels - SHOWN_LEVELS), levels];
  if (show === 'steps') return [0, BRIGHTEST_STEPS];
  return show === 'sharing' ? [0, Math.log2(Math.max(2, mostInstances))] : null;
}

/**
 * Returns red, green and blue, from 0 to 1, at a place of the scale from 0 to 1; surfaces face the
 * viewer. The port of heat() and shown() in light.glsl.
 * @param {Show} show @param {number} place @returns {number[]}
 */
export function scaleColor(show, place) {
  const v = show === 'steps' ? place : 0.12 + 0.8 * place;
  const angle = 2 * Math.PI * (0.5 / 3 + 1 - 1.2 * v), spread = 1.3 * v * (1 - v) * 0.5;
  const c = Math.cos(angle) * spread, s = Math.sin(angle) * spread;
  return [v - 0.14861 * c + 1.78277 * s, v - 0.29227 * c - 0.90649 * s, v + 1.97294 * c].map((x) => Math.min(1, Math.max(0, x)));
}

/**
 * Returns the uniforms of channelColor() in look.glsl. Whole numbers have more bits than floats: they count from the first colour.
 * @param {import('../file/scene_loader.js').Channel} channel @param {[number, number] | null} shown  The values of the first and the last colour.
 */
export function channelUniforms({ values, range }, shown) {
  // Ends that are one float have a step between them, of some floats.
  const isFloat = values instanceof Float32Array, ends = shown ?? range;
  const least = isFloat ? 0 : Math.max(-(2 ** 31), Math.min(Math.floor(ends[0]), 2 ** 31 - 1)), [low, high] = ends.map((x) => (isFloat ? x / 2 : x - least));
  return { ints: { u_channel: Number(isFloat), u_channel_least: least }, floats: { u_channel_ends: [low, Math.fround(high) > Math.fround(low) ? high : low + Math.abs(low) * 2 ** -22 + 1e-30] } };
}
