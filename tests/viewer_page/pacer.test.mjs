import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Pacer } from '../../apps/viewer/page/gpu/pacer.js';

const WIDTH = 1920, HEIGHT = 1080;

/** Renders samples of a picture; returns the frames and milliseconds that they take on a card of this speed. */
function render(pacer, samples, nsPerPixel, frameMs = 16) {
  let frames = 0, total = 0;
  for (let sample = 0; sample < samples; ++sample)
    for (let row = 0; row < HEIGHT; ++frames) {
      const rows = Math.min(pacer.rows(WIDTH, HEIGHT), HEIGHT - row);
      const ms = Math.max(frameMs, rows * WIDTH * nsPerPixel * 1e-6);
      pacer.learn(false, rows * WIDTH, ms);
      row += rows;
      total += ms;
    }
  return { frames, total };
}

test('a picture takes few frames on a fast card, also after a slow start', () => {
  const pacer = new Pacer();
  pacer.learn(false, 4 * WIDTH, 500);  // the first frame waits for shaders
  assert.equal(pacer.rows(WIDTH, HEIGHT), 4);
  const { frames } = render(pacer, 16, 2);
  assert.ok(frames < 16 + 20, `${frames} frames`);
});

test('no frame of a slow card takes much longer than its time, after the first ones', () => {
  const pacer = new Pacer();
  render(pacer, 1, 3000);
  const { frames, total } = render(pacer, 2, 3000);
  assert.ok(total / frames < 60, `${total / frames} ms per frame`);
  assert.ok(total < 1.1 * 2 * WIDTH * HEIGHT * 3000e-6, 'most of the time is work');
});

test('the scale of a moving picture is between a sixteenth and one', () => {
  const pacer = new Pacer();
  for (let i = 0; i < 50; ++i) pacer.learn(true, 1000, 1000);
  assert.equal(pacer.scale(WIDTH * HEIGHT), 1 / 16);
  for (let i = 0; i < 200; ++i) pacer.learn(true, WIDTH * HEIGHT, 1);
  assert.equal(pacer.scale(WIDTH * HEIGHT), 1);
});
