import assert from 'node:assert/strict';
import { test } from 'node:test';

import { channelUniforms, channelValue, rangeOf } from '../../apps/viewer/page/channels.js';
import { DEFAULTS, mergeSettings } from '../../apps/viewer/page/settings.js';
import { settingsFromHash, settingsToHash } from '../../apps/viewer/page/settings_link.js';
import { channelGradient } from '../../apps/viewer/page/ui/legend.js';
import { valueText } from '../../apps/viewer/page/ui/numbers.js';
import { randomNumbers } from './random.mjs';

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
    const channel = { kind: 'i32', bound: 0, values: numbers.length, words: packed(numbers) };
    assert.deepEqual(numbers.map((_, i) => channelValue(channel, i)), numbers);
    assert.deepEqual(rangeOf(channel), [Math.min(...numbers), Math.max(...numbers)]);
  }
});

test('floats are codes, or multiples of twice the bound', () => {
  const random = randomNumbers(3), values = Array.from({ length: 600 }, () => Math.fround((random() - 0.4) * 10 ** Math.floor(random() * 20 - 10)));
  const lossless = { kind: 'f32', bound: 0, values: 600, words: packed(values.map(codeOf)) };
  assert.deepEqual(values.map((_, i) => channelValue(lossless, i)), values);
  assert.deepEqual(rangeOf(lossless), [Math.min(...values), Math.max(...values)]);
  // Blocks 0 and 2 hold multiples, block 1 codes.
  const numbers = values.map((value, i) => (i >> 8 === 1 ? codeOf(value) : i % 90 - 20));
  const bounded = { kind: 'f32', bound: 0.1, values: 600, words: packed(numbers, (block) => block === 1) };
  values.forEach((value, i) => assert.equal(channelValue(bounded, i), i >> 8 === 1 ? value : Math.fround(numbers[i] * 0.2)));
});

test('whole numbers are compared with the least one before they become floats', () => {
  const time = { kind: 'i32', bound: 0, range: [1600000000, 1600000282] };
  assert.deepEqual(channelUniforms(time, null), { ints: { u_channel: 0, u_least_number: 1600000000 }, floats: { u_channel_scale: [0, 282, 8e8, 141] } });
  const { ints, floats } = channelUniforms(time, [1600000050.5, 1600000100]);
  assert.deepEqual([ints.u_least_number, ...floats.u_channel_scale.slice(0, 2)], [1600000050, 0.5, 49.5]);
  assert.deepEqual(channelUniforms({ kind: 'f32', bound: 0.25, range: [-20.5, 30] }, null).floats.u_channel_scale, [0, 101, -10.25, 25.25]);
  // A channel of one value has the first colour.
  assert.deepEqual(channelUniforms({ kind: 'u8', bound: 0, range: [7, 7] }, null).floats.u_channel_scale.slice(0, 2), [0, 1]);
  // Half the range of all floats is a float.
  const most = 3.4028234663852886e38;
  assert.equal(channelUniforms({ kind: 'f32', bound: 0, range: [-most, most] }, null).floats.u_channel_scale[3], most);
});

test('values are written with the digits that tell them from other floats', () => {
  assert.deepEqual([0.1, 1 / 3, 3.5, -2.25, 1e-7].map((x) => valueText(Math.fround(x))), ['0.1', '0.33333334', '3.5', '\u22122.25', '1e-7']);
  assert.deepEqual([0, -4, 16777217, 2147483647, 1e30].map(valueText), ['0', '\u22124', '16777217', '2147483647', '1e+30']);
});

test('the channel and its range are settings, and parts of a link', () => {
  const settings = mergeSettings(DEFAULTS, { channel: { name: 'heat', range: [-1.5, 20] } });
  assert.equal(settingsToHash(settings), 'channel=heat&range=-1.5,20');
  assert.deepEqual(settingsFromHash('#channel=heat&range=-1.5,20'), { settings, problems: [] });
  assert.equal(settingsToHash(mergeSettings(settings, { channel: { name: null, range: null } }), null, settings), 'channel=&range=none');
  assert.deepEqual(settingsFromHash('#channel=&range=none', settings).settings, DEFAULTS);
  assert.equal(settingsFromHash('#channel=none').settings.channel.name, 'none');
  assert.deepEqual(mergeSettings(settings, { channel: { range: null } }).channel, { name: 'heat', range: null });
  for (const [channel, reason] of [[{ name: 'a b' }, /"channel.name" is not a name/], [{ range: [2, 2] }, /must have its first number below/], [{ range: [1] }, /two numbers/]])
    assert.throws(() => mergeSettings(DEFAULTS, { channel }), reason);
  assert.equal(settingsFromHash('#range=3,1').problems.length, 1);
});

test('the colours of a legend lie at equal distances', () =>
  assert.equal(channelGradient([[68, 1, 84], [253, 231, 37]]), 'linear-gradient(to right, rgb(68 1 84), rgb(253 231 37))'));
