import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';

import { channelUniforms } from '../../apps/viewer/page/gpu/color_scale.js';
import { DEFAULTS, mergeSettings } from '../../apps/viewer/page/settings.js';
import { settingsFromHash, settingsToHash } from '../../apps/viewer/page/settings_link.js';
import { channelGradient } from '../../apps/viewer/page/ui/legend.js';
import { valueText } from '../../apps/viewer/page/ui/numbers.js';
import { randomNumbers } from './random.mjs';

/** Functions of the worker, whose script has no exports. */
const { decodeChannel, readChannelList } = new Function('CHANNELS', 'brokenFile', 'readPart', 'readSize', `${fs.readFileSync(new URL('../../apps/viewer/page/file/worker/attributes.js', import.meta.url), 'utf8')}
  return { decodeChannel, readChannelList };`)(
  { most: 16, headerBytes: 64, channels: 0, values: 8, entryBytes: 128, nameBytes: 64, kind: 64, bound: 72, words: 80, kinds: ['u8'], blockValues: 256, maxWidth: 32 },
  (text) => new Error(text), (_, bytes) => bytes, (view, at) => view.getUint32(at, true));

/** Packs numbers as docs/format.md says of CHAN, in blocks of 256. `exact` says which blocks hold codes. */
function packed(numbers, exact = () => false) {
  const blocks = [], bits = [];
  for (let first = 0; first < numbers.length; first += 256) {
    const part = numbers.slice(first, first + 256), minimum = Math.min(...part), width = (Math.max(...part) - minimum).toString(2).length * Number(Math.max(...part) > minimum);
    while (bits.length % 64) bits.push(0);
    blocks.push(bits.length / 64, 0, minimum >>> 0, width | (exact(first / 256) ? 64 : 0));
    for (const number of part) for (let i = 0; i < width; ++i) bits.push(Math.floor((number - minimum) / 2 ** i) % 2);
  }
  while (bits.length % 64) bits.push(0);
  const words = new Uint32Array(blocks.length + bits.length / 32);
  words.set(blocks);
  bits.forEach((bit, i) => { if (bit) words[blocks.length + (i >> 5)] |= 1 << (i & 31); });
  return words;
}

const codeOf = (value) => {
  const code = new Int32Array(Float32Array.of(value).buffer)[0];
  return code < 0 ? code ^ 0x7fffffff : code;
};

test('every value and the range are those that were packed', () => {
  for (const size of [1, 2, 300, 70000, 2 ** 32]) {
    const random = randomNumbers(size), numbers = Array.from({ length: 1500 }, () => Math.floor(random() * size) - (size > 1e9 ? 2 ** 31 : 7));
    const { values, range } = decodeChannel(packed(numbers), { name: 'a', kind: 'i32', bound: 0, values: 1500 }, 1500);
    assert.deepEqual([Array.from(values), range], [numbers, [Math.min(...numbers), Math.max(...numbers)]]);
  }
});

test('floats are codes, or multiples of twice the bound', () => {
  const random = randomNumbers(3), floats = Array.from({ length: 600 }, () => Math.fround((random() - 0.4) * 10 ** Math.floor(random() * 20 - 10)));
  const lossless = decodeChannel(packed(floats.map(codeOf)), { name: 'a', kind: 'f32', bound: 0, values: 600 }, 600);
  assert.deepEqual([Array.from(lossless.values), lossless.range], [floats, [Math.min(...floats), Math.max(...floats)]]);
  // Blocks 0 and 2 hold multiples, block 1 codes.
  const numbers = floats.map((value, i) => (i >> 8 === 1 ? codeOf(value) : i % 90 - 20));
  const { values } = decodeChannel(packed(numbers, (block) => block === 1), { name: 'a', kind: 'f32', bound: 0.1, values: 600 }, 600);
  floats.forEach((value, i) => assert.equal(values[i], i >> 8 === 1 ? value : Math.fround(numbers[i] * 0.2)));
});

test('words that lead outside, and floats that are no numbers, are refused', () => {
  const numbers = Array.from({ length: 300 }, (_, i) => i), of = { name: 'a', kind: 'i32', bound: 0, values: 300 }, words = packed(numbers);
  for (let length = 0; length < words.length - 1; ++length) assert.throws(() => decodeChannel(words.subarray(0, length), of, 300), /channel a/i);
  assert.throws(() => decodeChannel(words, of, 301), /has 300 values for 301 cells/);
  for (const [at, value] of [[0, 1000], [1, 1], [3, 33]]) assert.throws(() => decodeChannel(words.with(at, value), of, 300), /lies outside/);
  for (const codes of [[0x7fc00000, 0, 1], [0, 0x7fc00000], [0x7f800000, 0]])
    assert.throws(() => decodeChannel(packed(codes), { ...of, kind: 'f32', values: codes.length }, codes.length), /not finite numbers/);
});

test('whole numbers outside of their kind are refused', () => {
  for (const [kind, least, most] of [['u8', 0, 255], ['u16', 0, 65535], ['i16', -32768, 32767]]) {
    const decode = (...numbers) => decodeChannel(packed(numbers), { name: 'a', kind, bound: 0, values: 2 }, 2);
    assert.deepEqual(decode(least, most).range, [least, most]);
    assert.throws(() => decode(least - 1, most), /outside of its kind/);
    assert.throws(() => decode(least, most + 1), /outside of its kind/);
  }
});

test('a list with a name that is there already is refused', async () => {
  const bytes = new Uint8Array(64 + 2 * 128), chunk = { offset: 0, length: bytes.length };
  bytes[0] = 2;
  for (const [i, name] of ['a', 'b'].entries()) bytes[64 + 128 * i] = name.charCodeAt(0);
  assert.deepEqual((await readChannelList(null, bytes, chunk)).map(({ name }) => name), ['a', 'b']);
  bytes[64 + 128] = bytes[64];
  await assert.rejects(readChannelList(null, bytes, chunk), /two channels a/);
});

test('whole numbers are compared with the least one before they become floats', () => {
  const time = { values: new Int32Array(), range: [1600000000, 1600000282] }, heat = { values: new Float32Array(), range: [-20.5, 30] };
  assert.deepEqual(channelUniforms(time, null), { ints: { u_channel: 0, u_channel_least: 1600000000 }, floats: { u_channel_ends: [0, 282] } });
  assert.deepEqual(channelUniforms(time, [1600000050.5, 1600000100]), { ints: { u_channel: 0, u_channel_least: 1600000050 }, floats: { u_channel_ends: [0.5, 50] } });
  assert.deepEqual(channelUniforms(heat, null), { ints: { u_channel: 1, u_channel_least: 0 }, floats: { u_channel_ends: [-10.25, 15] } });
  // A channel of one value has the first colour.
  assert.deepEqual(channelUniforms({ values: new Int32Array(), range: [7, 7] }, null).floats.u_channel_ends, [0, 1e-30]);
  // Ends that are one float have a step between them.
  for (const ends of [[5, 5.0000001], [0, 1e-60], [-3e38, -3e38 + 1e20]]) {
    const [low, high] = channelUniforms(heat, ends).floats.u_channel_ends.map(Math.fround);
    assert.ok(low < high && high <= low + 4e-7 * Math.abs(low) + 1e-29, String(ends));
  }
  // Half the range of all floats is a float.
  const most = 3.4028234663852886e38, [low, high] = channelUniforms(heat, [-most, most]).floats.u_channel_ends;
  assert.equal(high - low, most);
});

test('values are written with the digits that tell them from other floats', () => {
  assert.deepEqual([0.1, 1 / 3, 3.5, -2.25, 1e-7].map((x) => valueText(Math.fround(x))), ['0.1', '0.33333334', '3.5', '\u22122.25', '1e-7']);
  assert.deepEqual([0, -4, 16777217, 2147483647, 1e30, Math.fround(1e30)].map(valueText), ['0', '\u22124', '16777217', '2147483647', '1e+30', '1e+30']);
  // Ends of a range are no floats.
  assert.deepEqual([1600000050.5, 0.1, 99.5].map(valueText), ['1600000050.5', '0.1', '99.5']);
  const random = randomNumbers(5);
  for (let i = 0; i < 1000; ++i) {
    const value = Math.fround((random() - 0.5) * 10 ** Math.floor(random() * 60 - 30));
    assert.equal(Math.fround(Number(valueText(value).replace('\u2212', '-'))), value);
  }
});

test('the channel and its range are settings, and parts of a link', () => {
  const settings = mergeSettings(DEFAULTS, { channel: { name: 'heat', range: [-1.5, 20] } });
  assert.equal(settingsToHash(settings), 'channel=heat&range=-1.5,20');
  assert.deepEqual(settingsFromHash('#channel=heat&range=-1.5,20'), { settings, problems: [] });
  assert.equal(settingsToHash(mergeSettings(settings, { channel: { name: '', range: null } }), null, settings), 'channel=&range=none');
  assert.deepEqual(settingsFromHash('#channel=&range=none', settings).settings, DEFAULTS);
  assert.equal(settingsFromHash('#channel=none').settings.channel.name, 'none');
  assert.deepEqual(mergeSettings(settings, { channel: { range: null } }).channel, { name: 'heat', range: null });
  for (const [channel, reason] of [[{ name: null }, /"channel.name" is not a text/], [{ range: [2, 2] }, /the smaller one first/], [{ range: [1] }, /two numbers/], [{ range: [-1e308, 1] }, /range of floats/]])
    assert.throws(() => mergeSettings(DEFAULTS, { channel }), reason);
  assert.equal(settingsFromHash('#range=3,1').problems.length, 1);
});

test('the colours of a legend lie at equal distances', () =>
  assert.equal(channelGradient([[68, 1, 84], [253, 231, 37]]), 'linear-gradient(to right, rgb(68 1 84), rgb(253 231 37))'));
