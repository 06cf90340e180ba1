import assert from 'node:assert/strict';
import { test } from 'node:test';

import { scaleColor, shownRange } from '../../apps/viewer/page/gpu/color_scale.js';
import { endLabels, gradient } from '../../apps/viewer/page/ui/legend.js';

test('the ends of the legend are the values that are shown darkest and brightest', () => {
  assert.deepEqual(endLabels('level', shownRange('level', 11, 1)), ['level 4', 'level 11']);
  assert.deepEqual(endLabels('level', shownRange('level', 3, 1)), ['level 0', 'level 3']);
  assert.deepEqual(endLabels('steps', shownRange('steps', 11, 1)), ['0 steps', '160 or more']);
  assert.deepEqual(endLabels('sharing', shownRange('sharing', 11, 2500)), ['used 1×', '2500×']);
  for (const show of ['light', 'normal', 'depth', 'occlusion']) assert.equal(shownRange(show, 11, 9), null);
});

test('the scale of steps begins with black and ends with white, and each scale becomes brighter', () => {
  assert.deepEqual(scaleColor('steps', 0), [0, 0, 0]);
  assert.deepEqual(scaleColor('steps', 1), [1, 1, 1]);
  for (const show of ['level', 'steps', 'sharing']) {
    const luma = (place) => scaleColor(show, place).reduce((sum, x, i) => sum + x * [0.299, 0.587, 0.114][i], 0);
    for (let i = 1; i <= 20; ++i) assert.ok(luma(i / 20) > luma((i - 1) / 20), `${show} at ${i}`);
    assert.match(gradient(show), /^linear-gradient\(to right(, rgb\(\d+ \d+ \d+\)){16}\)$/);
  }
});
