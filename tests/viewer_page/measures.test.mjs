import assert from 'node:assert/strict';
import { test } from 'node:test';

import { alongAxis, angleAt, heightOf, pathLength, polygonArea, roundBelow, unitFactor, valueOf } from '../../apps/viewer/page/measures.js';
import { keeps } from '../../apps/viewer/page/section_ray.js';
import { scaleOf } from '../../apps/viewer/page/ui/scale_bar.js';
import { randomNumbers } from './random.mjs';

const near = (a, b, slack = 1e-12) => assert.ok(Math.abs(a - b) <= slack * Math.max(1, Math.abs(b)), `${a}, not ${b}`);
/** A rotation by an orthonormal frame, and a translation: lengths, areas and angles stay. */
function rigid(seed) {
  const random = randomNumbers(seed), [a, b, c] = [0, 1, 2].map(() => random() * 2 * Math.PI), shift = [0, 1, 2].map(() => random() * 10 - 5);
  const turn = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
  return (p) => {
    let [x, y, z] = p;
    [x, y] = turn([x, y], a);
    [y, z] = turn([y, z], b);
    [z, x] = turn([z, x], c);
    return [x + shift[0], y + shift[1], z + shift[2]];
  };
}

test('lengths, areas and angles are exact for whole numbers', () => {
  assert.equal(pathLength([[0, 0, 0], [3, 4, 0], [3, 4, 12]]), 17);
  assert.equal(pathLength([[0, 0, 0], [3, 0, 0], [3, 4, 0]], true), 12);
  assert.equal(pathLength([[1, 2, 3]]), 0);
  assert.equal(polygonArea([[0, 0, 5], [4, 0, 5], [4, 3, 5], [0, 3, 5]]), 12);
  assert.equal(polygonArea([[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 1, 0], [0, 2, 0]]), 3, 'not convex');
  assert.equal(polygonArea([[0, 0, 0], [1, 0, 0]]), 0);
  assert.equal(angleAt([[1, 0, 0], [0, 0, 0], [0, 7, 0]]), 90);
  assert.equal(angleAt([[1, 0, 0], [0, 0, 0], [5, 5, 0]]), 45);
  assert.equal(angleAt([[1, 0, 0], [0, 0, 0], [-2, 0, 0]]), 180);
  assert.equal(angleAt([[1, 0, 0], [0, 0, 0], [2, 0, 0]]), 0);
  assert.equal(heightOf([[9, 9, 1], [0, 0, 4]], [0, 0, 1]), 3);
  assert.equal(heightOf([[0, 4, 0], [7, 1, 3]], [0, 1, 0]), 3);
});

test('moving and turning the scene changes no value', () => {
  for (let seed = 1; seed <= 200; ++seed) {
    const random = randomNumbers(seed), move = rigid(seed + 500);
    const n = 3 + Math.floor(random() * 9), radius = 0.1 + random() * 10;
    // The area of a regular polygon is n/2 r² sin(2 pi / n), its side 2 r sin(pi / n), its angle 180 - 360 / n.
    const polygon = Array.from({ length: n }, (_, i) => move([radius * Math.cos(2 * Math.PI * i / n), radius * Math.sin(2 * Math.PI * i / n), 0]));
    near(polygonArea(polygon), n / 2 * radius ** 2 * Math.sin(2 * Math.PI / n), 1e-11);
    near(pathLength(polygon, true), 2 * n * radius * Math.sin(Math.PI / n), 1e-11);
    near(angleAt(polygon.slice(0, 3)), 180 - 360 / n, 1e-9);
    near(valueOf({ kind: 'distance', points: polygon.slice(0, 2) }, [0, 1, 0]), 2 * radius * Math.sin(Math.PI / n), 1e-11);
  }
});

test('a polygon that is not flat has the area of its projection along its mean normal', () => {
  // A saddle over the unit square.
  near(polygonArea([[0, 0, 1], [1, 0, -1], [1, 1, 1], [0, 1, -1]]), 1);
});

test('units convert exactly', () => {
  assert.equal(unitFactor('ft', 'in') * 1, 0.3048 / 0.0254);
  near(unitFactor('ft', 'in'), 12);
  near(unitFactor('m', 'mm'), 1000);
  near(unitFactor('cm', 'mm'), 10);
  assert.equal(unitFactor(null, 'mm'), 1);
});

test('Shift keeps a point on the axis along which it is farthest', () => {
  assert.deepEqual(alongAxis([1, 1, 1], [1.2, -4, 2]), [1, -4, 1]);
  assert.deepEqual(alongAxis([0, 0, 0], [-3, 1, 2]), [-3, 0, 0]);
});

test('the scale bar has a round length, and the scale is true at 96 pixels per inch', () => {
  for (const [x, round] of [[1, 1], [1.9, 1], [2, 2], [4.99, 2], [5, 5], [9, 5], [10, 10], [0.07, 0.05], [1e-9, 1e-9]]) near(roundBelow(x), round);
  const { size, pixels, ratio } = scaleOf(0.01, 'm', 'm');  // a pixel is 1 cm
  assert.deepEqual([size, pixels], [1, 100]);
  near(ratio, 0.01 / (0.0254 / 96));
  assert.equal(scaleOf(0.01, 'm', 'cm').size, 100);
  assert.equal(scaleOf(3, null, null).ratio, null);
});

test('points in the part that a section removes count as cut away', () => {
  const section = { box: { low: [0, 0, 0], high: [2, 2, 2] }, plane: { point: [1, 0, 0], normal: [2, 0, 0] } };
  assert.ok(keeps(section, [0.5, 1, 1], 0) && keeps(section, [1, 1, 1], 0) && keeps(section, [1.05, 1, 1], 0.1));
  assert.ok(!keeps(section, [1.05, 1, 1], 0) && !keeps(section, [0.5, 3, 1], 0.1) && !keeps(section, [1.5, 1, 1], 0.1));
  assert.ok(keeps({ box: null, plane: null }, [9, 9, 9], 0));
});
