/** The channels of cells in memory: the port of stored/attributes/channels.hpp and channel_colors.cpp. */
import { PAGE_CELLS, bitsAt } from './materials.js';

/**
 * @typedef {import('./file/scene_loader.js').ChannelInfo} ChannelInfo
 * @typedef {[number, number]} Range  The least and the greatest value.
 * @typedef {ChannelInfo & {words: Uint32Array}} ChannelWords  In halves of the file's words.
 * @typedef {ChannelWords & {range: Range}} Channel
 */

const codes = new Int32Array(1), floats = new Float32Array(codes.buffer);

/** @param {number} code */
function floatOf(code) {
  codes[0] = code < 0 ? code ^ 0x7fffffff : code;
  return floats[0];
}

/** Returns the value for which a number of a block stands. @param {ChannelInfo} channel @param {boolean} isExact @param {number} number */
const valueOf = ({ kind, bound }, isExact, number) => (kind !== 'f32' ? number : bound === 0 || isExact ? floatOf(number) : Math.fround(number * (2 * bound)));

/** @param {ChannelWords} channel @param {number} i */
function blockAt({ words, values }, i) {
  const begin = words[4 * i] + 2 ** 32 * words[4 * i + 1], flags = words[4 * i + 3];
  return { bit: 32 * (4 * Math.ceil(values / PAGE_CELLS) + 2 * begin), minimum: words[4 * i + 2] | 0, width: flags & 63, isExact: ((flags >>> 6) & 1) === 1 };
}

/** Returns what is added to the minimum of a block. @param {Uint32Array} words @param {number} at  Its bit. @param {number} width */
const packedAt = (words, at, width) => bitsAt(words, at, Math.min(width, 16)) + (width > 16 ? 65536 * bitsAt(words, at + 16, width - 16) : 0);

/** Returns the value of the cell with a number. @param {ChannelWords} channel @param {number} number */
export function channelValue(channel, number) {
  const { bit, minimum, width, isExact } = blockAt(channel, Math.floor(number / PAGE_CELLS));
  return valueOf(channel, isExact, (minimum + packedAt(channel.words, bit + width * (number % PAGE_CELLS), width)) | 0);
}

/** Returns the least and the greatest value of a channel. @param {ChannelWords} channel @returns {Range} */
export function rangeOf(channel) {
  const { words, values } = channel;
  let least = Infinity, most = -Infinity;
  for (let i = 0; PAGE_CELLS * i < values; ++i) {
    const { bit, minimum, width, isExact } = blockAt(channel, i), count = Math.min(PAGE_CELLS, values - PAGE_CELLS * i);
    least = Math.min(least, valueOf(channel, isExact, minimum));
    // Most blocks cannot have a greater value than those before.
    if (valueOf(channel, isExact, Math.min(minimum + 2 ** width - 1, 2 ** 31 - 1)) <= most) continue;
    let top = 0;
    for (let k = 0; k < count; ++k) top = Math.max(top, packedAt(words, bit + width * k, width));
    most = Math.max(most, valueOf(channel, isExact, (minimum + top) | 0));
  }
  return [least, most];
}

/**
 * Returns the uniforms of channel.glsl. Whole numbers are compared as such: a float has too few bits for them.
 * @param {Channel} channel @param {Range | null} shown  The values of the first and the last colour.
 */
export function channelUniforms({ kind, bound, range }, shown) {
  const [least, most] = shown ?? range, step = bound > 0 ? 2 * bound : 1;
  const low = Math.max(-(2 ** 31), Math.min(Math.floor(least / step), 2 ** 31 - 1));
  return {
    ints: { u_channel: kind !== 'f32' ? 0 : bound > 0 ? 1 : 2, u_least_number: low },
    floats: { u_channel_scale: [least / step - low, (most - least) / step || 1, least / 2, most / 2 - least / 2 || 1] },
  };
}
