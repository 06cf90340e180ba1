import assert from 'node:assert/strict';
import { test } from 'node:test';

import {
  BACKGROUNDS, DEFAULTS, MEASURE_POINTS, MODES, SHOWS, TONES, UNITS, SettingsError, mergeSettings, settingsFromJson, settingsToJson,
} from '../../apps/viewer/page/settings.js';
import { settingsFromHash, settingsToHash } from '../../apps/viewer/page/settings_link.js';
import { randomNumbers } from './random.mjs';

/** Settings with every key at random, at a random scale. */
function randomSettings(seed) {
  const random = randomNumbers(seed);
  const scale = 10 ** (random() * 9 - 3);
  const pick = (list) => list[Math.floor(random() * list.length)];
  const maybe = (value) => (random() < 0.5 ? value() : null);
  const vector = (size = scale) => [0, 1, 2].map(() => (random() * 2 - 1) * size);
  const camera = () => ({ eye: vector(), target: vector(), up: vector(1), fov: 1 + random() * 120 });
  const list = (make) => Array.from({ length: Math.floor(random() * 4) }, (_, i) => make(i));
  const ordered = (a, b) => [a.map((x, i) => Math.min(x, b[i])), a.map((x, i) => Math.max(x, b[i]))];
  const box = () => { const [low, high] = ordered(vector(), vector()); return { low, high }; };
  const notes = ['', 'crack in the north wall', 'a&b=c;d#e%f,g~"\'<ü 漢字 🙂', 'two\nlines'];
  return mergeSettings(DEFAULTS, {
    camera: maybe(camera),
    sun: { direction: maybe(() => vector(1)), angle: random() * 5, on: random() < 0.5 },
    environment: { map: maybe(() => pick(['studio', 'overcast', 'sunset'])), turn: random() * 360 - 180 }, bounces: maybe(() => Math.floor(random() * 5)),
    sky: random() * 3, exposure: random() * 4, shadows: random() < 0.5,
    tone: pick(TONES), background: pick(BACKGROUNDS), ground: random() < 0.5,
    occlusion: { samples: Math.floor(random() * 256), distance: random() * scale, cone: random() },
    lod: random() * 4, cubes: random() * 100, level: maybe(() => Math.floor(random() * 20)),
    colors: random() < 0.5, normals: random() < 0.5, hidden: list((i) => 3 * i), show: pick(SHOWS), mode: pick(MODES),
    section: { box: maybe(box), plane: maybe(() => ({ point: vector(), normal: vector(1) })), hatch: random() < 0.5 },
    title: pick(notes), licence: pick(notes), unit: maybe(() => pick(UNITS)),
    measures: list(() => {
      const kind = pick(Object.keys(MEASURE_POINTS)), [least, most] = MEASURE_POINTS[kind];
      return { kind, points: Array.from({ length: Math.min(most, least + Math.floor(random() * 3)) }, () => vector()) };
    }),
    annotations: list(() => ({ text: pick(notes), point: vector(), camera: camera() })),
    path: list((i) => {
      const key = { time: i + random(), eye: vector(), target: vector() };
      if (random() < 0.5) key.up = vector(1);
      if (random() < 0.5) key.fov = 20 + random() * 40;
      return key;
    }),
  });
}

test('random settings survive the hash exactly', () => {
  for (let seed = 1; seed <= 500; ++seed) {
    const settings = randomSettings(seed);
    const read = settingsFromHash('#' + settingsToHash(settings));
    assert.deepEqual(read.problems, []);
    assert.deepEqual(read.settings, settings);
  }
});

test('a hash holds what differs from the settings of the page, and nothing else', () => {
  for (let seed = 1; seed <= 500; ++seed) {
    const base = randomSettings(seed), settings = randomSettings(seed + 1000);
    assert.equal(settingsToHash(base, null, base), '');
    const hash = settingsToHash(settings, null, base), read = settingsFromHash(hash, base);
    assert.deepEqual(read.problems, []);
    assert.deepEqual(read.settings, settings);
    assert.deepEqual(settingsFromHash(settingsToHash(DEFAULTS, null, base), base).settings, DEFAULTS);
  }
});

test('settings hold the map of an environment, which a link only holds if the page begins with it', () => {
  const map = { name: 'a.hdr', side: 2, texels: btoa('\x80\x80\x80\x81'.repeat(4)), sun: [1, 2, 3], towards: [0, 1, 0] };
  const own = mergeSettings(DEFAULTS, { environment: { map } });
  assert.deepEqual(settingsFromJson(settingsToJson(own)), own);
  assert.equal(settingsToHash(own, null, own), '');
  assert.equal(settingsToHash(own), '');
  assert.equal(settingsToHash(DEFAULTS, null, own), 'environment=none');
  const refused = (changes, message) => assert.throws(() => mergeSettings(DEFAULTS, { environment: { map: { ...map, ...changes } } }), { message });
  refused({ side: 3 }, '"environment.map.texels" is not the base64 of 36 bytes');
  refused({ texels: '*'.repeat(24) }, '"environment.map.texels" is not the base64 of 16 bytes');
  refused({ sun: [-1, 0, 0] }, '"environment.map.sun" is negative');
  assert.throws(() => mergeSettings(DEFAULTS, { environment: { map: 'moon' } }), { message: '"environment.map" is not one of studio, overcast, sunset' });
});

test('measures of older files and links are distances', () => {
  const distance = { kind: 'distance', points: [[0, 0, 0], [1, 2, 3]] };
  assert.deepEqual(settingsFromJson('{"measures": [{"from": [0, 0, 0], "to": [1, 2, 3]}]}').measures, [distance]);
  assert.deepEqual(settingsFromHash('measure=0,0,0;1,2,3').settings.measures, [distance]);
  assert.equal(settingsToHash({ ...DEFAULTS, measures: [distance] }), 'measure=0,0,0;1,2,3');
});

test('a browser keeps the hash as it is', () => {
  for (let seed = 1; seed <= 50; ++seed) {
    const hash = settingsToHash(randomSettings(seed));
    assert.equal(new URL('http://localhost/#' + hash).hash, hash ? '#' + hash : '');
  }
});

test('random settings survive JSON exactly', () => {
  for (let seed = 1; seed <= 200; ++seed) {
    const settings = randomSettings(seed);
    assert.deepEqual(settingsFromJson(settingsToJson(settings)), settings);
  }
});

test('the hash of the defaults is empty, and so is that of the home view', () => {
  assert.equal(settingsToHash(DEFAULTS), '');
  const home = { eye: [1, 2, 3], target: [0, 0, 0], up: [0, 1, 0], fov: 40 };
  assert.equal(settingsToHash({ ...DEFAULTS, camera: home }, home), '');
  assert.equal(settingsToHash({ ...DEFAULTS, camera: home }), 'eye=1,2,3&target=0,0,0&up=0,1,0&fov=40');
});

test('a key with a wrong type is an error that names the key', () => {
  const wrong = [
    [{ camera: { eye: [1, 2], target: [0, 0, 0] } }, '"camera.eye" is not an array of three numbers'],
    [{ camera: { eye: [1, 2, 3] } }, '"camera.target" is missing'],
    [{ camera: { eye: [1, 2, 3], target: [1, 2, 3] } }, '"camera" has eye and target at one point'],
    [{ camera: { eye: [0, 2, 0], target: [0, 0, 0] } }, '"camera.up" points along the view'],
    [{ sun: { direction: [0, 0, 0] } }, '"sun.direction" is zero; it must be a direction'],
    [{ sun: { on: 1 } }, '"sun.on" is not true or false'],
    [{ sky: '1' }, '"sky" is not a number'],
    [{ level: 1.5 }, '"level" is not a whole number'],
    [{ show: 'lights' }, '"show" is not one of light, level, steps, sharing, normal, depth, occlusion'],
    [{ section: { box: { low: [0, 0, 0] } } }, '"section.box.high" is missing'],
    [{ section: { box: { low: [0, 2, 0], high: [1, 1, 1] } } }, '"section.box" has a low corner above its high corner'],
    [{ measures: [{ from: [0, 0, 0], to: 'x' }] }, '"measures[0].to" is not an array of three numbers'],
    [{ measures: [{ kind: 'area', points: [[0, 0, 0], [1, 0, 0]] }] }, '"measures[0].points" has 2 points; a measure of kind area has 3 or more'],
    [{ measures: [{ kind: 'volume', points: [] }] }, '"measures[0].kind" is not one of distance, path, area, angle, height'],
    [{ path: [{ time: 1, eye: [0, 0, 0], target: [1, 0, 0] }, { time: 1, eye: [0, 0, 0], target: [1, 0, 0] }] },
      '"path[1].time" is not greater than the time of the key before'],
    [{ version: 2 }, '"version" is 2; this viewer reads version 1'],
    [[], '"settings" is not an object'],
    [null, '"settings" is not an object'],
  ];
  for (const [value, message] of wrong)
    assert.throws(() => settingsFromJson(JSON.stringify(value)), { message });
  assert.throws(() => settingsFromJson('{'), SettingsError);
});

test('unknown keys are ignored and reported', () => {
  const ignored = [];
  const settings = settingsFromJson('{"sky": 2, "moon": 1, "sun": {"age": 5}, "__proto__": {"x": 1}}', ignored);
  assert.equal(settings.sky, 2);
  assert.deepEqual(ignored, ['moon', 'sun.age', '__proto__']);
  assert.equal({}.x, undefined);
});

test('merging changes only what is given, and never the settings before', () => {
  const before = JSON.stringify(DEFAULTS);
  const settings = mergeSettings(DEFAULTS, { sun: { angle: 2 } });
  assert.deepEqual(settings.sun, { direction: null, angle: 2, on: true });
  assert.equal(JSON.stringify(DEFAULTS), before);
});

test('a wrong pair of a link is left out, the others count', () => {
  const { settings, problems } = settingsFromHash('#sky=2&show=nothing&eye=1,2&target=0,0,0&level=3&moon=1&note=1;%E0%A4%A');
  assert.equal(settings.sky, 2);
  assert.equal(settings.level, 3);
  assert.equal(settings.camera, null);
  assert.equal(problems.length, 4);
});

test('random text as a hash never throws', () => {
  const random = randomNumbers(7);
  const alphabet = 'eye=target&up,;%#0123456789.-note key measure box plane\u0000é';
  for (let i = 0; i < 5000; ++i) {
    let hash = '#';
    for (let n = random() * 40; n > 0; --n) hash += alphabet[Math.floor(random() * alphabet.length)];
    settingsFromHash(hash);
  }
  for (const key of ['eye', 'note', 'key', 'box', 'plane', 'measure', 'sun'])
    for (const value of ['', ';', ',', 'a;b', '1,2,3', '1,2,3;', ';;;;;;;;', 'NaN,NaN,NaN', 'Infinity,0,0'])
      settingsFromHash(`#${key}=${value}`);
});
