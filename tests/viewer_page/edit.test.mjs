/** Edits in the page: brushes, updates of the server, and requests. */
import assert from 'node:assert/strict';
import { test } from 'node:test';

import { Stroke, lineOf } from '../../apps/viewer/page/edit/brush.js';
import { EditClient } from '../../apps/viewer/page/edit/client.js';
import { serverEditor } from '../../apps/viewer/page/edit/editors.js';
import { floorHit } from '../../apps/viewer/page/edit/floor.js';
import { applyUpdate, parseUpdate, withRuns } from '../../apps/viewer/page/edit/update.js';
import { overlayAt } from '../../apps/viewer/page/materials.js';
import { NO_NODE, bounds, cast, contains } from '../../apps/viewer/page/trace.js';

/** @type {import('../../apps/viewer/page/edit/brush.js').Brush} */
const BALL = { verb: 'remove', shape: 'ball', radius: 2, color: '#ff8000', material: 3 };
const HEAD = [7, 40, 1, 2, 3, 5, 6];

test('a brush is a line of a script in world units', () => {
  assert.equal(lineOf(BALL, [9, 9, 9], [1, 2, 3.5]), 'remove,ball,1,2,3.5,2');
  assert.equal(lineOf({ ...BALL, verb: 'add' }, [9, 9, 9], [1, 2, 3]), 'add,ball,1,2,3,2,#ff8000,material=3');
  assert.equal(lineOf({ ...BALL, verb: 'paint', shape: 'box', material: null }, [9, 9, 9], [1, 2, 3]), 'paint,box,-1,0,1,3,4,5,#ff8000');
  assert.equal(lineOf({ ...BALL, shape: 'capsule' }, [0, 1, 2], [3, 4, 5]), 'remove,capsule,0,1,2,3,4,5,2');
});

/** Draws over a surface whose points are where the pointer is. @param {Partial<typeof BALL>} brush @param {[number, number][]} way @param {(x: number) => boolean} [has] */
async function drawn(brush, way, has = () => true) {
  /** @type {{line: string, isFirst: boolean}[]} */
  const drawn = [];
  const pick = async (/** @type {number} */ x, /** @type {number} */ y) => (has(x) ? /** @type {any} */ ({ position: [x / 10, y / 10, 0] }) : null);
  const stroke = new Stroke({ ...BALL, ...brush }, pick, () => 0.1, (line, isFirst) => drawn.push({ line, isFirst }), 0.1);
  for (const [x, y] of way) stroke.move(x, y);
  await stroke.work;
  return drawn;
}

test('a fast drag leaves no gaps, and a slow one no more edits than needed', async () => {
  const fast = await drawn({}, [[0, 0], [100, 0]]), slow = await drawn({}, Array.from({ length: 101 }, (_, x) => /** @type {[number, number]} */ ([x, 0])));
  assert.equal(fast.length, 11);  // every half radius, over 10 units
  assert.equal(slow.length, 11);
  assert.deepEqual(fast.map(({ isFirst }) => isFirst), [true, ...Array(10).fill(false)]);
});

test('a stroke of capsules is connected, but not over a gap in the surface', async () => {
  const lines = (await drawn({ shape: 'capsule' }, [[0, 0], [40, 0]])).map(({ line }) => line.split(',').slice(2, 8).map(Number));
  assert.deepEqual(lines[0].slice(0, 3), lines[0].slice(3));
  for (let i = 1; i < lines.length; ++i) assert.deepEqual(lines[i].slice(0, 3), lines[i - 1].slice(3));
  const broken = (await drawn({ shape: 'capsule' }, [[0, 0], [100, 0]], (x) => x < 30 || x > 70)).map(({ line }) => line.split(',').map(Number));
  assert.equal(broken.filter((line) => line[2] === line[5]).length, 2);
});

test('a brush beside the surface is on the lower side of the grid', () => {
  const info = /** @type {any} */ ({ origin: [10, 20, 30], voxelSize: 0.5, resolution: 32, levels: 5, view: { up: [0, 1, 0] } });
  assert.deepEqual(floorHit(info, [14, 28, 34], [0, -1, 0.25]), { voxel: [8, 0, 12], level: 5, face: 3, position: [14, 20, 36], distance: 8 });
  assert.deepEqual(floorHit({ ...info, view: { up: [0, 0.1, -1] } }, [14, 28, 34], [0, 0, 1]), { voxel: [8, 16, 31], level: 5, face: 4, position: [14, 28, 46], distance: 12 });
  for (const [from, direction] of [[[14, 28, 34], [0, 1, 0]], [[14, 28, 34], [1, 0, 0]], [[14, 28, 34], [-1, -1, 0]], [[14, 19, 34], [0, -1, 0]]])
    assert.equal(floorHit(info, /** @type {any} */ (from), /** @type {any} */ (direction)), null);
});

test('an update brings its runs into memory and textures, and its roots', () => {
  const update = parseUpdate(Uint32Array.from([...HEAD, 2, 1, 1, 4, 2, 9, 1, 1, 2, 8, 8, 10, 11, 12, 1, 2, 3, 4, ...Array(8).fill(2 ** 31 + 5)]).buffer);
  assert.deepEqual([update.writer, update.version, update.undos, update.redos], [7, { root: 40, colors: 1, normals: 2, materials: 3 }, 5, 6]);
  /** @type {any[]} */
  const uploads = [];
  const texture = (/** @type {string} */ name) => ({ set: (/** @type {number} */ first, /** @type {Uint32Array} */ values) => uploads.push([name, first, ...values]) });
  const memory = /** @type {any} */ ({ nodes: new Uint32Array(12), leaves: new Uint32Array(8), overlay: new Uint32Array(16), version: {} });
  const textures = /** @type {any} */ ({ nodes: texture('nodes'), leaves: texture('leaves'), overlay: texture('overlay') });
  applyUpdate(update, memory, textures, 1e6);
  assert.deepEqual([...memory.nodes.subarray(4, 10)], [10, 11, 0, 0, 0, 12]);
  assert.deepEqual([...memory.leaves], [0, 0, 1, 2, 3, 4, 0, 0]);
  assert.equal(memory.version.root, 40);
  assert.deepEqual(uploads.slice(0, 3), [['nodes', 4, 10, 11], ['nodes', 9, 12], ['leaves', 1, 1, 2, 3, 4]]);
  assert.deepEqual(overlayAt(memory.overlay, 1, [3, 0, 0], 2, 2, false), 5);
  assert.throws(() => parseUpdate(Uint32Array.from([...HEAD, 1, 0, 0, 4, 2, 10]).buffer), /broken/);
});

test('arrays grow with what they had, and a card that is full says so', () => {
  const array = Uint32Array.from([1, 2, 3, 4]), runs = [{ first: 2, values: Uint32Array.from([5, 6]) }];
  assert.equal(withRuns(array, 1, runs), array);
  const larger = withRuns(array, 2, runs);
  assert.deepEqual([...larger.subarray(0, 6)], [1, 2, 5, 6, 5, 6]);
  assert.ok(larger.length % 2 === 0 && larger.length > 6);
  const update = parseUpdate(Uint32Array.from([...HEAD, 1, 0, 0, 100, 1, 9]).buffer);
  const memory = /** @type {any} */ ({ nodes: new Uint32Array(1), leaves: new Uint32Array(2), overlay: new Uint32Array(), version: {} });
  assert.throws(() => applyUpdate(update, memory, /** @type {any} */ ({}), 50), /cannot hold more/);
});

test('values of an overlay hold for all of a cell; those of parts stand for a cell that the file lacks', () => {
  const value = 2 ** 31 + 9, words = Uint32Array.from([...Array(8).fill(0), 0, 2, 0, value, 0, 0, 0, 0, 0, 0, 0, 2 ** 31 + 7, 0, 0, 0, 0]);
  assert.equal(overlayAt(words, 1, [3, 3, 0], 2, 2, false), 9);
  assert.equal(overlayAt(words, 1, [3, 1, 0], 2, 2, false), 7);
  assert.equal(overlayAt(words, 1, [2, 0, 0], 2, 2, false), null);
  assert.equal(overlayAt(words, 1, [2, 0, 0], 1, 2, false), null);
  assert.equal(overlayAt(words, 1, [2, 0, 0], 1, 2, true), 7);
  assert.equal(overlayAt(words, value, [0, 0, 0], 2, 2, false), 9);
});

test('rays and points see the version of the root', () => {
  // Grids of 4³: block 0 has voxel (0,0,0), block 1 voxel (1,0,0).
  const dag = { levels: 2, shown: 2, origin: /** @type {[number, number, number]} */ ([0, 0, 0]), voxelSize: 1, nodes: new Uint32Array(), leaves: Uint32Array.from([1, 0, 2, 0]) };
  for (const [root, x] of [[0, 0], [1, 1]]) {
    const version = { ...dag, root };
    assert.deepEqual(cast(version, [-1, 0.5, 0.5], [1, 0, 0])?.voxel, [x, 0, 0]);
    assert.ok(contains(version, [x + 0.5, 0.5, 0.5]) && !contains(version, [1.5 - x, 0.5, 0.5]));
    assert.deepEqual(bounds(version, 9), { low: [x, 0, 0], high: [x + 1, 1, 1] });
  }
  const none = { ...dag, root: NO_NODE };
  assert.deepEqual([cast(none, [-1, 0.5, 0.5], [1, 0, 0]), contains(none, [0.5, 0.5, 0.5]), bounds(none, 9)], [null, false, null]);
});

test('requests follow each other; what is drawn meanwhile goes in one; a failure drops what waits', async () => {
  /** @type {{path: string, body: string}[]} */
  const asked = [];
  /** @type {(() => void)[]} */
  const release = [];
  let status = 200;
  Object.assign(globalThis, {
    document: { baseURI: 'http://127.0.0.1:1/?edit=s' },
    fetch: async (/** @type {URL} */ url, /** @type {any} */ { body, headers }) => {
      assert.equal(headers['Voxdag-Token'], 'secret');
      asked.push({ path: url.pathname + url.search, body });
      await new Promise((resolve) => release.push(() => resolve(undefined)));
      return status === 200 ? new Response(Uint32Array.from([...HEAD, 0, 0, 0])) : new Response('line 1: wrong\n', { status });
    },
  });
  const turn = () => new Promise((resolve) => setTimeout(resolve, 5));
  /** @type {string[]} */
  const told = [];
  const client = new EditClient(serverEditor('secret'), () => told.push('taken'), (error) => told.push(error.message));
  client.draw('a', true);
  client.draw('b', false);
  client.draw('c', false);
  client.undo();
  client.draw('d', true);
  const answer = async (/** @type {number} */ i) => {
    while (release.length <= i) await turn();
    release[i]();
  };
  const rest = async () => { while (client.isBusy) await turn(); };
  for (let i = 0; i < 4; ++i) await answer(i);
  await rest();
  assert.deepEqual(asked.map(({ path, body }) => `${path} ${body}`), ['/edit/stroke a', '/edit/stroke?more b\nc', '/edit/undo ', '/edit/stroke d']);
  assert.equal(client.writer, 7);
  status = 400;
  client.draw('e', true);
  client.undo();
  await answer(4);
  await rest();
  assert.deepEqual([asked.length, told], [5, ['taken', 'taken', 'taken', 'taken', 'line 1: wrong']]);
});
