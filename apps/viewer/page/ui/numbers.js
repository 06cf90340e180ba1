/** Formats numbers for people. */

/** Returns a size with its unit; 1 KB is 1000 bytes. @param {number} bytes */
export function bytesText(bytes) {
  if (!Number.isFinite(bytes)) return '–';
  const units = ['bytes', 'KB', 'MB', 'GB', 'TB'];
  let unit = 0;
  for (; bytes >= 1000 && unit < 4; ++unit) bytes /= 1000;
  return `${unit === 0 || bytes >= 100 ? Math.round(bytes) : bytes.toPrecision(3)} ${units[unit]}`;
}

/** Returns a count: exact below a million. @param {number} count */
export function countText(count) {
  if (!Number.isFinite(count)) return '–';
  if (count < 1e4) return String(Math.round(count));
  if (count < 1e6) return Math.round(count).toLocaleString('en').replaceAll(',', '\u202f');
  return count < 1e9 ? `${(count / 1e6).toPrecision(4)} million` : `${(count / 1e9).toPrecision(4)} billion`;
}

/**
 * Returns a length or coordinate with the decimals that `step`, a voxel's size, deserves.
 * @param {number} x @param {number} step
 */
export function lengthText(x, step) {
  const decimals = Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(step))));
  const text = Math.abs(x) < 1e9 && (Math.abs(x) >= 1e-6 || x === 0) ? x.toFixed(decimals) : x.toPrecision(7);
  return text.replace('-', '\u2212');
}

/** Returns an angle in whole degrees. @param {number} x */
export const degrees = (x) => `${Math.round(x)}°`.replace('-', '\u2212');

/** Returns a count with two digits. @param {number} count */
export const roundText = (count) => (count < 1e6 ? countText(+count.toPrecision(2)) : count < 1e9 ? `${+(count / 1e6).toPrecision(2)} million` : `${+(count / 1e9).toPrecision(2)} billion`);

/** Returns a time as a person would say it. @param {number} seconds */
export const secondsText = (seconds) => (seconds < 1 ? 'less than a second' : seconds < 99 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} minutes`);

/** Returns a value of a channel: a float with as few digits as tell it from other floats, another number in full. @param {number} value */
export function valueText(value) {
  let digits = 1, text = String(value);
  if (!Number.isSafeInteger(value) && Math.fround(value) === value)
    do text = String(Number(value.toPrecision(digits)));
    while (digits++ < 9 && Math.fround(Number(text)) !== value);
  return text.replace(/^-/, '\u2212');
}
