import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Pad, stick } from '../../apps/viewer/page/hands/gamepad.js';

const pad = (axes, values = {}) => ({
  axes, buttons: Array.from({ length: 17 }, (_, i) => ({ value: values[i] ?? 0, pressed: (values[i] ?? 0) > 0.5 })),
});

test('a stick near its middle does nothing, and its ends are full speed', () => {
  for (const x of [0, 0.1, -0.14]) assert.equal(stick(x), 0);
  assert.equal(stick(1), 1);
  assert.equal(stick(-1), -1);
  assert.ok(stick(0.5) > 0 && stick(0.5) < 0.5);
  assert.equal(stick(NaN), 0);
});

test('sticks up are forward and up, triggers zoom in orbit and lift in flight', () => {
  const up = pad([0, -1, 0, -1], { 7: 1 });
  assert.deepEqual(new Pad().read(up, true).input, { move: [0, 0, 1], turn: [0, 1], zoom: 1, fast: false, jump: false });
  assert.deepEqual(new Pad().read(up, false).input, { move: [0, 1, 1], turn: [0, 1], zoom: 0, fast: false, jump: false });
});

test('a button that stays down is pressed once', () => {
  const hand = new Pad(), held = pad([0, 0, 0, 0], { 3: 1 });
  assert.equal(hand.read(held, true).pressed[3], true);
  assert.equal(hand.read(held, true).pressed[3], false);
  hand.read(pad([0, 0, 0, 0]), true);
  assert.equal(hand.read(held, true).pressed[3], true);
});
