import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Navigator, NO_INPUT, accelerated, covered } from '../../apps/viewer/page/hands/navigator.js';
import { STEEPEST, VIEWS, cameraOf, eyeOf, forwardOf, poseOf, roundCamera } from '../../apps/viewer/page/hands/pose.js';
import { directionThrough, project } from '../../apps/viewer/page/lens.js';
import { boxScene, room } from './box_scene.mjs';
import { randomNumbers } from './random.mjs';

const SCALES = [1e-3, 1, 1e6];
const away = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
const input = (changes) => ({ ...NO_INPUT, ...changes });

function navigator(scale = 1, mode = 'orbit') {
  const hands = new Navigator(room(scale));
  hands.width = 800;
  hands.height = 600;
  hands.setMode(mode);
  return hands;
}

/** Steps until nothing moves; returns the seconds. */
function rest(hands, time = 1 / 60) {
  let total = 0;
  while (hands.step(time, NO_INPUT)) {
    total += time;
    assert.ok(total < 30, 'comes to rest');
  }
  return total;
}

function steps(hands, seconds, rate, what) {
  for (let i = 0; i < Math.round(seconds * rate); ++i) hands.step(1 / rate, what);
}

test('damping composes: many short steps cover as much as a long one', () => {
  let left = 1;
  for (let i = 0; i < 100; ++i) left *= 1 - covered(0.01, 0.07);
  assert.ok(Math.abs(left - (1 - covered(1, 0.07))) < 1e-12);
  const once = accelerated([1, 2, 3], [4, 0, -2], 1, 0.3);
  let speed = [1, 2, 3], way = [0, 0, 0];
  for (let i = 0; i < 200; ++i) {
    const part = accelerated(speed, [4, 0, -2], 1 / 200, 0.3);
    speed = part.speed;
    way = way.map((x, axis) => x + part.way[axis]);
  }
  assert.ok(away(once.speed, speed) < 1e-9 && away(once.way, way) < 1e-9);
});

test('a drag ends at one camera and passes the same cameras at any frame rate', () => {
  const shown = [30, 60, 120, 1000].map((rate) => {
    const hands = navigator();
    hands.rotate(120, 40);
    hands.pan(30, -20);
    const halfway = () => { steps(hands, 0.2, rate, NO_INPUT); return hands.camera; };
    const middle = halfway();
    rest(hands, 1 / rate);
    return [middle, hands.camera];
  });
  for (const [middle, end] of shown) {
    assert.ok(away(middle.eye, shown[0][0].eye) < 1e-9);
    assert.ok(away(end.eye, shown[0][1].eye) < 1e-9);
  }
});

test('flying and walking go equally far at any frame rate', () => {
  for (const mode of ['fly', 'walk']) {
    const ends = [30, 60, 144, 240].map((rate) => {
      const hands = navigator(1, mode);
      steps(hands, 1, rate, NO_INPUT);  // the walker lands
      const start = hands.camera.eye;
      steps(hands, 1.5, rate, input({ move: [0, 0, 1] }));
      rest(hands, 1 / rate);
      return [start, hands.camera.eye];
    });
    const way = away(...ends[0]);
    assert.ok(way > 0.3, mode);
    // Flying looks ahead once a frame, which is a second-order effect.
    for (const [, end] of ends) assert.ok(away(end, ends[0][1]) < 0.03 * way, `${mode}: ${ends}`);
  }
});

test('the point under the pointer stays there while zooming, in every frame', () => {
  const random = randomNumbers(3);
  for (const scale of SCALES)
    for (let i = 0; i < 50; ++i) {
      const hands = navigator(scale);
      hands.rotate(random() * 300, random() * 100 - 50);
      rest(hands);
      const x = 100 + random() * 600, y = 100 + random() * 400;
      const point = hands.pointUnder(x, y);
      for (let turn = 0; turn < 4; ++turn) hands.zoom(x, y, 0.6 + random() * 0.8);
      for (let frame = 0; frame < 40; ++frame) {
        hands.step(1 / 60, NO_INPUT);
        const seen = project(hands.camera, point, 800, 600);
        assert.ok(Math.hypot(seen.x - x, seen.y - y) < 1e-3, `scale ${scale}: ${seen.x - x} ${seen.y - y}`);
      }
    }
});

test('a grabbed point follows the pointer while panning', () => {
  for (const scale of SCALES) {
    const hands = navigator(scale);
    const point = hands.pointUnder(500, 400);
    hands.pan(60, -35, point);
    rest(hands);
    const seen = project(hands.camera, point, 800, 600);
    assert.ok(Math.hypot(seen.x - 560, seen.y - 365) < 0.01, `${seen.x} ${seen.y}`);
  }
});

test('zooming ends in front of the surface and within a hundred sizes', () => {
  for (const scale of SCALES) {
    const hands = navigator(scale);
    for (let i = 0; i < 300; ++i) { hands.zoom(400, 300, 0.8); hands.step(1 / 60, NO_INPUT); }
    rest(hands);
    assert.ok(hands.shown.distance >= hands.least * 0.99 && hands.shown.distance < 10 * hands.least);
    for (let i = 0; i < 600; ++i) { hands.zoom(400, 300, 1.3); hands.step(1 / 60, NO_INPUT); }
    rest(hands);
    assert.ok(hands.shown.distance <= hands.most * 1.01);
  }
});

test('the pole is never crossed, and turning goes on there', () => {
  const hands = navigator();
  for (const way of [1, -1]) {
    for (let i = 0; i < 100; ++i) { hands.rotate(13, 200 * way); hands.step(1 / 60, NO_INPUT); }
    rest(hands);
    assert.ok(Math.abs(Math.abs(hands.shown.pitch) - STEEPEST) < 1e-6);
    const across = Math.hypot(...[0, 2].map((i) => hands.camera.eye[i] - hands.camera.target[i]));
    assert.ok(across > 1e-3 * hands.shown.distance);
    const yaw = hands.shown.yaw;
    hands.rotate(50, 0);
    rest(hands);
    assert.ok(hands.shown.yaw > yaw + 0.2);
  }
});

test('looking around keeps the eye, orbiting keeps the target', () => {
  for (const mode of ['fly', 'orbit']) {
    const hands = navigator(1, mode), before = hands.camera;
    for (let i = 0; i < 20; ++i) {
      if (mode === 'fly') hands.look(31, -7); else hands.rotate(31, -7);
      hands.step(1 / 60, NO_INPUT);
      const fixed = mode === 'fly' ? 'eye' : 'target';
      assert.ok(away(hands.camera[fixed], before[fixed]) < 1e-9, mode);
    }
  }
});

test('any up axis keeps the horizon level', () => {
  for (const up of [[0, 0, 1], [1, 0, 0], [0, -1, 0], [0.3, -0.5, 0.8]]) {
    const hands = navigator();
    hands.setCamera({ eye: [5, 4, 3], target: [0, 1, 0], up, fov: 40 });
    hands.rotate(77, 31);
    rest(hands);
    const camera = hands.camera, size = Math.hypot(...up);
    assert.ok(away(camera.up, up.map((x) => x / size)) < 1e-12);
    // A point above the target is straight above it in the picture.
    const [low, high] = [camera.target, camera.target.map((x, i) => x + up[i] * 0.1)].map((p) => project(camera, p, 800, 600));
    assert.ok(Math.abs(low.x - high.x) < 1e-6 && high.y < low.y);
  }
});

test('a camera becomes a pose and back', () => {
  const random = randomNumbers(11);
  for (let i = 0; i < 1000; ++i) {
    const vector = () => [random() - 0.5, random() - 0.5, random() - 0.5].map((x) => x * 10);
    const camera = { eye: vector(), target: vector(), up: vector(), fov: 30 };
    const pose = poseOf(camera);
    if (Math.abs(pose.pitch) === STEEPEST) continue;
    const back = cameraOf(pose);
    assert.ok(away(back.eye, camera.eye) < 1e-9 && away(back.target, camera.target) < 1e-12);
  }
});

test('rays and projection agree', () => {
  const random = randomNumbers(5);
  const camera = { eye: [3, 2, 7], target: [-1, 0.5, 0], up: [0.1, 1, 0.2], fov: 33 };
  for (let i = 0; i < 200; ++i) {
    const x = random() * 1280, y = random() * 720, t = random() * 100;
    const point = directionThrough(camera, x, y, 1280, 720).map((d, axis) => camera.eye[axis] + d * t);
    const seen = project(camera, point, 1280, 720);
    assert.ok(Math.abs(seen.x - x) < 1e-6 && Math.abs(seen.y - y) < 1e-6);
  }
});

test('framing shows all of the scene, as large as possible, from every side', () => {
  for (const scale of SCALES)
    for (const name of [...Object.keys(VIEWS), 'as it is'])
      for (const [width, height] of [[390, 844], [1280, 720]]) {
        const hands = navigator(scale);
        Object.assign(hands, { width, height });
        if (name === 'as it is') { hands.rotate(99, 33); rest(hands); hands.frame(); } else hands.view(name);
        rest(hands);
        const { low, high } = hands.scene.bounds;
        let most = 0;
        for (let i = 0; i < 8; ++i) {
          const corner = [0, 1, 2].map((axis) => (i >> axis & 1 ? high : low)[axis]);
          const seen = project(hands.camera, corner, width, height);
          assert.ok(seen.depth > 0);
          most = Math.max(most, Math.abs(2 * seen.x / width - 1), Math.abs(2 * seen.y / height - 1));
        }
        assert.ok(most < 0.96 && most > 0.85, `${name} ${width}: ${most}`);
      }
});

test('the walker falls to the ground, climbs a step and stops at walls', () => {
  for (const scale of SCALES) {
    const hands = navigator(scale, 'walk');
    steps(hands, 2, 60, NO_INPUT);
    const height = hands.walker.eyeHeight;
    assert.ok(Math.abs(eyeOf(hands.shown)[1] - height) < 0.01 * scale);
    // North is a wall at z = -9: the body stops a radius before it.
    steps(hands, 30, 60, input({ move: [0, 0, 1], fast: true }));
    assert.ok(eyeOf(hands.shown)[2] > -9 * scale && eyeOf(hands.shown)[2] < -7.5 * scale, `${eyeOf(hands.shown)}`);
    // Along the wall to the east: up the step at x = 4, not up the block at x = 10.
    steps(hands, 20, 60, input({ move: [1, 0, 0.5], fast: true }));
    const eye = eyeOf(hands.shown);
    assert.ok(Math.abs(eye[1] - height - 0.3 * scale) < 0.01 * scale, `${eye}`);
    assert.ok(eye[0] < 10 * scale && eye[0] > 8 * scale, `${eye}`);
    rest(hands);
  }
});

test('the walker rests on ground that rays find only as exactly as floats', () => {
  for (const scale of SCALES) {
    const hands = navigator(scale, 'walk'), { cast } = hands.scene;
    const random = randomNumbers(13);
    hands.scene.cast = (...ray) => {
      const hit = cast(...ray);
      return hit && { ...hit, distance: hit.distance + (random() - 0.5) * 0.05 * hands.scene.voxelSize };
    };
    hands.setCamera({ eye: [scale, 3 * scale, 2 * scale], target: [0, 0, 0], up: [0, 1, 0], fov: 50 });
    steps(hands, 3, 60, input({ move: [0, 0, 1] }));
    assert.ok(rest(hands) < 3);
  }
});

test('the walker jumps and lands, and nobody falls out of the scene', () => {
  const hands = navigator(1, 'walk');
  rest(hands);
  const ground = eyeOf(hands.shown)[1];
  let highest = ground;
  for (let i = 0; i < 120; ++i) {
    hands.step(1 / 60, input({ jump: i < 2 }));
    highest = Math.max(highest, eyeOf(hands.shown)[1]);
  }
  assert.ok(highest > ground + 0.3 * hands.walker.eyeHeight);
  assert.ok(Math.abs(eyeOf(hands.shown)[1] - ground) < 1e-3);
  hands.setCamera({ eye: [100, 5, 100], target: [0, 0, 0], up: [0, 1, 0], fov: 40 });
  steps(hands, 10, 60, NO_INPUT);
  assert.ok(eyeOf(hands.shown)[1] >= -1);
});

test('a flight ends exactly at its camera; a gesture ends it', () => {
  const hands = navigator();
  const camera = { eye: [9, 3, -4], target: [1, 1, 1], up: [0, 1, 0], fov: 60 };
  hands.flyTo(camera);
  rest(hands);
  assert.ok(away(hands.camera.eye, camera.eye) < 1e-9);
  hands.view('top');
  hands.step(0.1, NO_INPUT);
  hands.rotate(1, 0);
  assert.equal(hands.flight, null);
});

test('with reduced motion the camera is at its goal after one frame', () => {
  const hands = navigator();
  hands.reducedMotion = true;
  hands.rotate(100, 10);
  hands.step(1 / 60, NO_INPUT);
  assert.equal(hands.shown, hands.goal);
  hands.view('top');
  assert.equal(hands.flight, null);
});

test('a settled camera has short numbers and shows the same picture', () => {
  for (const scale of SCALES) {
    const hands = navigator(scale);
    hands.rotate(123.4, 17.7);
    rest(hands);
    const before = hands.camera, camera = hands.settle();
    assert.deepEqual(camera, roundCamera(camera));
    assert.ok(camera.eye.every((x) => String(x).length <= 12), `${camera.eye}`);
    const point = hands.pointUnder(300, 200);
    const [a, b] = [before, camera].map((c) => project(c, point, 3840, 2160));
    assert.ok(Math.hypot(a.x - b.x, a.y - b.y) < 0.02);
  }
});

test('random gestures in all modes at all scales never give NaN, and come to rest', () => {
  for (const scale of [1e-3, 1, 1e6, 1e-20, 1e20])
    for (let seed = 1; seed <= 20; ++seed) {
      const random = randomNumbers(seed);
      const hands = navigator(scale);
      const pixels = () => (random() - 0.5) * 10 ** (random() * 5);
      const acts = [
        () => hands.rotate(pixels(), pixels()), () => hands.look(pixels(), pixels(), random() < 0.5),
        () => hands.pan(pixels(), pixels()), () => hands.pan(pixels(), pixels(), hands.pointUnder(random() * 800, random() * 600)),
        () => hands.zoom(random() * 800, random() * 600, Math.exp((random() - 0.5) * 20)),
        () => hands.zoom(0, 0, NaN), () => hands.rotate(NaN, 0), () => hands.pan(Infinity, 0),
        () => hands.frame(), () => hands.view(Object.keys(VIEWS)[Math.floor(random() * 6)]), () => hands.view('home'),
        () => hands.focus(hands.pointUnder(random() * 800, random() * 600)), () => hands.changeSpeed(Math.exp(random() * 6 - 3)),
        () => hands.setMode(['orbit', 'fly', 'walk'][Math.floor(random() * 3)]), () => hands.settle(),
      ];
      for (let i = 0; i < 100; ++i) {
        acts[Math.floor(random() * acts.length)]();
        const unit = () => Math.round(random() * 2 - 1);
        steps(hands, random() * 0.3, 60, input({ move: [unit(), unit(), unit()], turn: [unit(), unit()], zoom: unit(), fast: random() < 0.5 }));
        const { eye, target, up } = hands.camera;
        assert.ok([...eye, ...target, ...up].every(Number.isFinite));
        assert.ok(away(eye, target) > 0);
        assert.ok(Math.abs(Math.hypot(...forwardOf(hands.shown)) - 1) < 1e-9);
      }
      rest(hands);
    }
});

test('an empty scene, and one of a single point, have a camera', () => {
  const point = { low: [5, 5, 5], high: [5, 5, 5] };
  const home = { eye: [5, 5, 8], target: [5, 5, 5], up: [0, 1, 0], fov: 40 };
  const hands = new Navigator(boxScene([], { bounds: point, home, voxelSize: 0.1 }));
  for (const mode of ['orbit', 'fly', 'walk']) {
    hands.setMode(mode);
    hands.frame();
    hands.zoom(0.5, 0.5, 0.1);
    steps(hands, 1, 60, input({ move: [1, 1, 1] }));
    rest(hands);
    assert.ok(hands.camera.eye.every(Number.isFinite));
  }
});
