import assert from 'node:assert/strict';
import { test } from 'node:test';

import { castInSection, partInSection } from '../../apps/viewer/page/section_ray.js';
import { randomNumbers } from './random.mjs';

test('the part of a ray holds just the points that the section keeps', () => {
  const random = randomNumbers(9);
  const vector = (size) => [0, 1, 2].map(() => (random() * 2 - 1) * size);
  for (let i = 0; i < 2000; ++i) {
    const a = vector(1), b = vector(1);
    const box = random() < 0.7 ? { low: a.map((x, k) => Math.min(x, b[k])), high: a.map((x, k) => Math.max(x, b[k])) } : null;
    const plane = random() < 0.7 ? { point: vector(1), normal: vector(1) } : null;
    const origin = vector(2), direction = vector(1);
    if (random() < 0.1) direction[0] = 0;
    const part = partInSection({ box, plane }, origin, direction, 4);
    for (let k = 0; k < 40; ++k) {
      const t = random() * 4, p = origin.map((x, axis) => x + direction[axis] * t);
      const kept = (!box || p.every((x, axis) => x >= box.low[axis] && x <= box.high[axis])) &&
        (!plane || plane.normal.reduce((sum, n, axis) => sum + n * (p[axis] - plane.point[axis]), 0) <= 0);
      assert.equal(part !== null && t >= part[0] && t <= part[1], kept);
    }
  }
});

test('a hit behind the section has its distance from the origin', () => {
  const section = { box: { low: [2, -1, -1], high: [5, 1, 1] }, plane: null };
  const hit = castInSection(section, [0, 0, 0], [1, 0, 0], Infinity, (from, direction, most) => {
    assert.deepEqual([from, most], [[2, 0, 0], 3]);
    return { distance: 1 };
  });
  assert.equal(hit.distance, 3);
  assert.equal(castInSection(section, [0, 3, 0], [1, 0, 0], Infinity, () => ({ distance: 1 })), null);
});
