import assert from 'node:assert/strict';
import { test } from 'node:test';

import { typedNumber } from '../../apps/viewer/page/ui/controls.js';

test('a number is read as people type it', () => {
  const words = new Map([['off', 0], ['automatic', -1]]);
  const read = [
    ['12.5', 12.5], ['12,5', 12.5], ['\u22123', -3], ['- 4.25', -4.25], ['.5', 0.5], ['7.', 7], ['× 1.5', 1.5], ['45°', 45], ['12 %', 12], ['1e-3', 0.001],
    ['off', 0], [' Automatic ', -1], ['5 (32³)', 5], ['', null], ['abc', null], ['-', null], ['\u2212', null],
  ];
  for (const [typed, value] of read) assert.equal(typedNumber(typed, words), value, typed);
});
