import assert from 'node:assert/strict';
import { test } from 'node:test';

import { bytesText, countText, lengthText } from '../../apps/viewer/page/ui/numbers.js';
import { EDGES, cornerOf, cutPolygon, rangeAlong, withFace } from '../../apps/viewer/page/box.js';
import { Projection, pathOf } from '../../apps/viewer/page/ui/overlay.js';
import { axisVector, ballVector } from '../../apps/viewer/page/ui/section_handles.js';
import { sunDirection } from '../../apps/viewer/page/sun.js';
import { skyAngles, skyDirection } from '../../apps/viewer/page/ui/sky_angles.js';
import { randomNumbers } from './random.mjs';

const camera = { eye: [6, 4, 9], target: [0, 1, 0], up: [0, 1, 0], fov: 45 };
const projection = new Projection(camera, 1280, 720);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function vectors(seed, size = 1) {
  const random = randomNumbers(seed);
  return () => [0, 1, 2].map(() => (random() * 2 - 1) * size);
}

test('a handle on a line follows the pointer along the line', () => {
  const vector = vectors(1);
  const random = randomNumbers(2);
  for (let i = 0; i < 500; ++i) {
    const point = vector(), axis = vector(), t = random() * 4 - 2;
    const spot = projection.at(point.map((x, k) => x + axis[k] * t));
    const found = projection.along(point, axis, spot.x, spot.y);
    if (found !== null) assert.ok(Math.abs(found - t) < 1e-6, `${found}, not ${t}`);
  }
});

test('a line that points at the camera has no place for the pointer', () => {
  assert.equal(projection.along(camera.target, sub(camera.eye, camera.target), 640, 360), null);
});

test('points behind the camera are clipped, and no others', () => {
  const ahead = [[1, 0, 0], [0, 2, 1], [-1, 1, 2]];
  assert.deepEqual(projection.clipped(ahead, true), ahead.map((point) => { const { x, y } = projection.at(point); return { x, y }; }));
  const behind = [[12, 8, 18], [13, 8, 18], [12, 9, 19]];
  assert.deepEqual(projection.clipped(behind, true), []);
  assert.equal(projection.at(behind[0]), null);
  const across = projection.clipped([ahead[0], behind[0]], false);
  assert.equal(across.length, 2);
  assert.ok(across.every(({ x, y }) => Math.abs(x) <= 1e5 && Math.abs(y) <= 1e5));
  assert.equal(pathOf([]), '');
  const vector = vectors(4, 30);
  for (let i = 0; i < 500; ++i)
    for (const { x, y } of projection.clipped([vector(), vector(), vector(), vector()], true)) assert.ok(Number.isFinite(x) && Number.isFinite(y));
});

test('a plane cuts a box in a convex polygon on both', () => {
  const vector = vectors(5);
  const box = { low: [-1, -2, -0.5], high: [1, 2, 0.5] };
  let most = 0;
  for (let i = 0; i < 1000; ++i) {
    const plane = { point: vector(), normal: vector() }, polygon = cutPolygon(box, plane);
    most = Math.max(most, polygon.length);
    const heights = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => dot(plane.normal, sub(cornerOf(box, corner), plane.point)));
    assert.equal(polygon.length >= 3, Math.min(...heights) < 0 && Math.max(...heights) >= 0);
    polygon.forEach((corner, k) => {
      assert.ok(Math.abs(dot(plane.normal, sub(corner, plane.point))) < 1e-9);
      corner.forEach((x, axis) => assert.ok(x > box.low[axis] - 1e-9 && x < box.high[axis] + 1e-9));
      const next = polygon[(k + 1) % polygon.length], after = polygon[(k + 2) % polygon.length];
      assert.ok(dot(cross(sub(next, corner), sub(after, next)), plane.normal) > -1e-9);
    });
  }
  assert.equal(most, 6);
  assert.equal(EDGES.length, 12);
});

test('a face of the box never passes the opposite face', () => {
  const box = { low: [0, 0, 0], high: [1, 1, 1] };
  assert.deepEqual(withFace(box, 0, 5, 0.1), { low: [0.9, 0, 0], high: [1, 1, 1] });
  assert.deepEqual(withFace(box, 5, -5, 0.1), { low: [0, 0, 0], high: [1, 1, 0.1] });
  assert.deepEqual(withFace(box, 3, 0.5, 0.1), { low: [0, 0, 0], high: [1, 0.5, 1] });
  assert.deepEqual(box, { low: [0, 0, 0], high: [1, 1, 1] });
});

test('a plane moves between the lowest and the highest corner of the box', () => {
  const box = { low: [-1, 2, -3], high: [4, 5, 6] };
  assert.deepEqual(rangeAlong(box, axisVector(2)), [-3, 6]);
  const unit = [0.6, -0.8, 0], [low, high] = rangeAlong(box, unit);
  assert.ok(Math.abs(low - (-0.6 - 4)) < 1e-12 && Math.abs(high - (2.4 - 1.6)) < 1e-12);
});

test('the ball under the ring has unit vectors', () => {
  const random = randomNumbers(6);
  for (let i = 0; i < 200; ++i) assert.ok(Math.abs(Math.hypot(...ballVector(random() * 4 - 2, random() * 4 - 2)) - 1) < 1e-12);
});

test('the sun has angles with any up axis, and is over the left shoulder without a direction', () => {
  for (const up of [[0, 1, 0], [0, 0, 1], [1, 0, 0], [0, 0, -1]])
    for (const [azimuth, elevation] of [[0, 0], [30, 45], [200, -10], [359, 80]]) {
      const found = skyAngles(skyDirection(azimuth, elevation, up), up);
      assert.ok(Math.abs(((found.azimuth - azimuth + 540) % 360) - 180) < 0.01 && Math.abs(found.elevation - elevation) < 0.01);
    }
  // The formula of render/render_plan.cpp for a camera that looks along -z.
  const view = { eye: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 40 };
  const size = Math.hypot(0.9, 0.6, 0.25);
  const usual = [-0.6, 0.9, 0.25];
  sunDirection(null, view, usual).forEach((x, i) => assert.ok(Math.abs(x - [-0.6 / size, 0.9 / size, 0.25 / size][i]) < 1e-12));
  assert.deepEqual(sunDirection([0, 2, 0], view, usual), [0, 1, 0]);
});

test('numbers are short and have units', () => {
  assert.equal(bytesText(999), '999 bytes');
  assert.equal(bytesText(2905984), '2.91 MB');
  assert.equal(bytesText(26817920000), '26.8 GB');
  assert.equal(countText(2048), '2048');
  assert.equal(countText(171432), '171\u202f432');
  assert.equal(countText(39550000), '39.55 million');
  assert.equal(lengthText(-1805.0912, 0.18), '\u22121805.09');
  assert.equal(lengthText(0.00123456, 1e-5), '0.001235');
  assert.equal(lengthText(1e12, 1), '1.000000e+12');
});
