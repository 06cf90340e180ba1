/** Compares pictures. */
import fs from 'node:fs';
import zlib from 'node:zlib';

/**
 * @typedef {{width: number, height: number, luma: Float64Array}} Picture brightness of each pixel, 0 to 255
 * @typedef {Picture & {channels: number, rows: Uint8Array}} Pixels its bytes, 3 or 4 for each pixel
 */

/** Reads a PNG of 8 bits, RGB or RGBA. @param {Buffer | string} from bytes or path @returns {Pixels} */
export function readPng(from) {
  const bytes = typeof from === 'string' ? fs.readFileSync(from) : from;
  const parts = [];
  let width = 0, height = 0, channels = 3;
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at), kind = bytes.toString('latin1', at + 4, at + 8), data = bytes.subarray(at + 8, at + 8 + length);
    if (kind === 'IHDR') {
      width = data.readUInt32BE(0);
      height = data.readUInt32BE(4);
      channels = data[9] === 6 ? 4 : 3;
      if (data[8] !== 8 || (data[9] !== 2 && data[9] !== 6) || data[12] !== 0) throw new Error('a PNG of another kind');
    }
    if (kind === 'IDAT') parts.push(data);
    at += 12 + length;
  }
  const raw = zlib.inflateSync(Buffer.concat(parts)), stride = width * channels;
  const rows = new Uint8Array(height * stride);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? rows[y * stride + x - channels] : 0, up = y > 0 ? rows[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y > 0 ? rows[(y - 1) * stride + x - channels] : 0;
      const guess = left + up - corner, [a, b, c] = [left, up, corner].map((v) => Math.abs(guess - v));
      const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      rows[y * stride + x] = raw[y * (stride + 1) + 1 + x] + [0, left, up, (left + up) >> 1, paeth][raw[y * (stride + 1)]];
    }
  const luma = new Float64Array(width * height);
  for (let i = 0; i < luma.length; ++i) luma[i] = 0.299 * rows[i * channels] + 0.587 * rows[i * channels + 1] + 0.114 * rows[i * channels + 2];
  return { width, height, channels, rows, luma };
}

/**
 * Returns the structural similarity of two pictures (Wang, Bovik, Sheikh and Simoncelli 2004): the
 * mean over all windows of 8×8 pixels.
 * @param {Picture} a @param {Picture} b
 */
export function ssim(a, b) {
  if (a.width !== b.width || a.height !== b.height) throw new Error(`sizes differ: ${a.width}x${a.height}, ${b.width}x${b.height}`);
  const side = 8, n = side * side, c1 = (0.01 * 255) ** 2, c2 = (0.03 * 255) ** 2;
  let sum = 0, windows = 0;
  for (let y = 0; y + side <= a.height; y += 2)
    for (let x = 0; x + side <= a.width; x += 2) {
      let sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
      for (let v = 0; v < side; ++v)
        for (let u = 0; u < side; ++u) {
          const p = a.luma[(y + v) * a.width + x + u], q = b.luma[(y + v) * a.width + x + u];
          sa += p; sb += q; saa += p * p; sbb += q * q; sab += p * q;
        }
      const ma = sa / n, mb = sb / n, va = saa / n - ma * ma, vb = sbb / n - mb * mb, cov = sab / n - ma * mb;
      sum += ((2 * ma * mb + c1) * (2 * cov + c2)) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
      ++windows;
    }
  return sum / windows;
}

/** Returns the spread of a picture's brightness: near 0 if it is blank. @param {Picture} picture */
export function spread({ luma }) {
  const mean = luma.reduce((s, v) => s + v, 0) / luma.length;
  return Math.sqrt(luma.reduce((s, v) => s + (v - mean) ** 2, 0) / luma.length);
}
