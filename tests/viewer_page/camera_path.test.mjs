import assert from 'node:assert/strict';
import { test } from 'node:test';

import { cameraAt, completeKeys, frameTimes, pathToJson, turntable, withKey, withKeyAt, withTime, withoutKey } from '../../apps/viewer/page/hands/camera_path.js';
import { DEFAULTS, mergeSettings } from '../../apps/viewer/page/settings.js';

const FIRST = { eye: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0], fov: 40 };
const KEYS = [
  { time: 0, eye: [0, 1, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 40 },
  { time: 1.5, eye: [4, 2, 3], target: [0.5, 0.25, 0], fov: 50 },
  { time: 2, eye: [4, 2, 3], target: [0.5, 0.5, -1], up: [0.1, 1, 0], fov: 30 },
  { time: 5, eye: [-3, 0.5, -6], target: [0, 0, 1], up: [0, 1, 0] },
];
/** Time, eye, target, up and fov of these keys by CameraPath::at() of render/film/camera_path.cpp. */
const OF_CPP = [
  [0.20, [0.670295348236, 1.16757383706, 4.66485232588], [0.0633486142109, 0.0306660366244, 0.00403308192412], [0, 1, 0], 41.4874074074],
  [0.75, [3.08593749843, 1.77148437461, 3.45703125078], [0.221339475443, 0.103130803485, 0.0301557369477], [0, 1, 0], 46.25],
  [1.40, [3.99941187644, 1.99985296911, 3.00029406178], [0.462607037238, 0.224392856662, 0.0276426478277], [0, 1, 0], 49.9140740741],
  [1.70, [4, 2, 3], [0.569801509045, 0.371842213986, -0.372624880093], [0.0352, 1, 0], 42.96],
  [2.50, [3.96461621729, 1.99241776085, 2.95450656508], [0.407514192995, 0.437913055474, -0.751652221896], [0.0949074074074, 1, 0], 30],
  [3.90, [0.946036423562, 1.34557923362, -0.926524598278], [0.163095287324, 0.175772383848, 0.296910464608], [0.0451814814815, 1, 0], 30],
  [4.99, [-2.97651111457, 0.505033332591, -5.96980000445], [0.00166497943989, 0.00166730591443, 0.993330776342], [0.000334440740741, 1, 0], 30],
];

test('a path is that of `voxdag render --path`', () => {
  const keys = completeKeys(KEYS, FIRST);
  for (const [time, ...expected] of OF_CPP) {
    const { eye, target, up, fov } = cameraAt(keys, time);
    [...eye, ...target, ...up, fov].forEach((x, i) =>
      assert.ok(Math.abs(x - expected.flat()[i]) < 1e-9, `at ${time}: ${x}, not ${expected.flat()[i]}`));
  }
});

test('a path passes through its keys and stays at its ends', () => {
  const keys = completeKeys(KEYS, FIRST);
  for (const { time, eye } of keys)
    cameraAt(keys, time).eye.forEach((x, i) => assert.ok(Math.abs(x - eye[i]) < 1e-12));
  assert.deepEqual(cameraAt(keys, -5).eye, keys[0].eye);
  assert.deepEqual(cameraAt(keys, 50).eye, keys[3].eye);
  assert.deepEqual(cameraAt(keys.slice(0, 1), 3).target, keys[0].target);
});

test('recorded keys leave out what does not change, and mean what was recorded', () => {
  const cameras = [FIRST, { ...FIRST, eye: [1, 0, 9] }, { ...FIRST, fov: 50 }, { ...FIRST, fov: 50, up: [1, 0, 0] }];
  let keys = [];
  for (const camera of cameras) keys = withKey(keys, camera, 2.5);
  assert.deepEqual(keys.map((key) => Object.keys(key).join()),
    ['time,eye,target,up,fov', 'time,eye,target', 'time,eye,target,fov', 'time,eye,target,up']);
  assert.deepEqual(completeKeys(keys, FIRST), cameras.map((camera, i) => ({ time: i * 2.5, ...camera })));
  assert.deepEqual(mergeSettings(DEFAULTS, { path: keys }).path, keys);
  for (let i = 0; i < 4; ++i) {
    const rest = completeKeys(withoutKey(keys, i), FIRST);
    assert.deepEqual(rest, completeKeys(keys, FIRST).filter((_, k) => k !== i));
  }
});

test('a key at another time takes the later keys along, and stays behind the key before', () => {
  const times = (keys) => keys.map((key) => key.time);
  assert.deepEqual(times(withTime(KEYS, 1, 3.25)), [0, 3.25, 3.75, 6.75]);
  assert.deepEqual(times(withTime(KEYS, 2, -4)), [0, 1.5, 1.501, 4.501]);
  assert.deepEqual(times(withTime(KEYS, 0, -1)), [-1, 0.5, 1, 4]);
  assert.deepEqual(mergeSettings(DEFAULTS, { path: withTime(KEYS, 3, 0) }).path, [...KEYS.slice(0, 3), { ...KEYS[3], time: 2.001 }]);
});

test('a path file has one line per key and only keys that `render --path` reads', () => {
  const text = pathToJson(KEYS, [0, 1, 0.5]);
  assert.deepEqual(JSON.parse(text), { sun: [0, 1, 0.5], keys: KEYS });
  assert.equal(text.split('\n').length, KEYS.length + 6);
});

test('a key that is dragged stays between its neighbours, which stay where they are', () => {
  const times = (keys) => keys.map((key) => key.time);
  assert.deepEqual(times(withKeyAt(KEYS, 1, 0.7)), [0, 0.7, 2, 5]);
  assert.deepEqual(times(withKeyAt(KEYS, 1, 9)), [0, 1.999, 2, 5]);
  assert.deepEqual(times(withKeyAt(KEYS, 2, -9)), [0, 1.5, 1.501, 5]);
  assert.deepEqual(times(withKeyAt(KEYS, 3, 60)), [0, 1.5, 2, 60]);
  assert.deepEqual(times(withKeyAt(KEYS, 0, -3)), [-3, 1.5, 2, 5]);
  assert.deepEqual(mergeSettings(DEFAULTS, { path: withKeyAt(KEYS, 1, 9) }).path[1].time, 1.999);
});

test('a turntable is a circle around the target, and ends where it began', () => {
  const camera = { eye: [4, 3, 0], target: [1, 1, 1], up: [0, 2, 0], fov: 35 };
  const path = turntable(camera, 10), keys = completeKeys(mergeSettings(DEFAULTS, { path }).path, FIRST);
  assert.deepEqual([keys[0].time, keys.at(-1).time], [0, 10]);
  assert.deepEqual(keys.at(-1).eye, camera.eye);
  const radius = Math.hypot(3, 1);
  for (let time = 0; time <= 10; time += 0.05) {
    const { eye, target, up, fov } = cameraAt(keys, time);
    [...target, ...up, fov].forEach((x, i) => assert.ok(Math.abs(x - [1, 1, 1, 0, 2, 0, 35][i]) < 1e-9));
    assert.ok(Math.abs(eye[1] - 3) < 1e-9);
    assert.ok(Math.abs(Math.hypot(eye[0] - 1, eye[2] - 1) - radius) < 0.01 * radius, `at ${time}`);
  }
  const quarter = cameraAt(keys, 2.5).eye;  // counterclockwise from above: from +x towards -z
  [1 + -1, 3, 1 - 3].forEach((x, i) => assert.ok(Math.abs(quarter[i] - x) < 1e-9));
});

test('a film has a frame at both ends', () => {
  assert.deepEqual(frameTimes([{ time: 1 }, { time: 2 }], 4), [1, 1.25, 1.5, 1.75, 2]);
  assert.deepEqual(frameTimes([{ time: 0 }, { time: 0.3 }], 10).length, 4);
  assert.deepEqual(frameTimes([{ time: 5 }], 30), [5]);
});
