import { File } from 'node:buffer';
import assert from 'node:assert/strict';
import fs from 'node:fs';
import { test } from 'node:test';
import vm from 'node:vm';
import zlib from 'node:zlib';

import { openFiles } from '../../apps/viewer/page/ui/open_file.js';
import { DEFAULTS, NO_PLACES, mergeSettings } from '../../apps/viewer/page/settings.js';

// Debian's Node 18 has it in node:buffer only.
globalThis.File ??= File;

/** The part of the worker that reads files of this computer. */
const worker = vm.runInNewContext(
  ['source', 'blob_source'].map((name) => fs.readFileSync(new URL(`../../apps/viewer/page/file/worker/${name}.js`, import.meta.url), 'utf8')).join('') +
    '({ openBlob, BASE64_PART })',
  { FILE: { magic: [...Buffer.from('VOXDAG\r\n')] }, Blob, Response, DecompressionStream, TextDecoder, Uint8Array, atob });

const SCENE = Buffer.concat([Buffer.from('VOXDAG\r\n'), Buffer.from(Array.from({ length: 3_000_000 }, (_, i) => (i * 2654435761 >>> 13) & 255))]);
/** A page as `voxdag export` writes it, whose worker's text names the element of the scene too. */
const page = (scene, more = '') => `<!doctype html>\n<html><body><script type="text/plain" data-path="x.js">' id="scene">'</script>\n${more}` +
  `<script type="text/plain" id="scene">${scene}</script>\n<script type="module">import 'x';</script>\n</body></html>`;
const packed = zlib.gzipSync(SCENE, { level: 0 }).toString('base64');
const open = (...parts) => worker.openBlob(new Blob(parts));
const bytesOf = async ({ source }) => {
  const bytes = new Uint8Array(source.size);
  await source.read(bytes, 0);
  return Buffer.from(bytes);
};

test('a file and a page hold the same scene', async () => {
  assert.ok(packed.length > 2 * worker.BASE64_PART);
  assert.deepEqual(await bytesOf(await open(SCENE)), SCENE);
  assert.deepEqual(await bytesOf(await open(page(packed))), SCENE);
  const part = new Uint8Array(10);
  await (await open(SCENE)).source.read(part, 100);
  assert.deepEqual(Buffer.from(part), SCENE.subarray(100, 110));
});

test('a page gives its settings', async () => {
  assert.equal((await open(page(packed))).settings, null);
  assert.equal((await open(page(packed, '<script type="application/json" id="settings">{"sky":2}</script>\n'))).settings, '{"sky":2}');
});

test('a file of another kind and a broken page say so', async () => {
  await assert.rejects(open('\x89PNG'), { title: 'This file is of another kind' });
  await assert.rejects(open(''), { title: 'This file is of another kind' });
  await assert.rejects(open('<html><body>news</body></html>'), { title: 'This page holds no scene' });
  for (const scene of [packed.slice(0, 5000), packed.slice(1), 'not base64!', zlib.gzipSync(SCENE).subarray(0, 9000).toString('base64'), ''])
    await assert.rejects(open(page(scene)), { title: 'This page is damaged' });
  await assert.rejects((await open(SCENE)).source.read(new Uint8Array(1), SCENE.length), { title: 'This file is damaged' });
});

const openFile = (ui, file) => openFiles(ui, [{ name: file.name, data: file }]);

/** An interface whose viewer notes what it is told. */
function fakeUi() {
  const ui = {
    toasts: [], opened: [], settings: DEFAULTS,
    toast: (text) => ui.toasts.push(text), open() {},
    viewer: { get: () => ui.settings, set: (changes) => { ui.settings = mergeSettings(ui.settings, changes); }, open: async (file) => { ui.opened.push(file.name); } },
  };
  return ui;
}

test('the contents decide how a file is opened, and each failure is one line', async () => {
  const ui = fakeUi();
  await openFile(ui, new File([SCENE], 'a.vdag'));
  await openFile(ui, new File([page(packed)], 'b.html'));
  assert.deepEqual(ui.opened, ['a.vdag', 'b.html']);
  await openFile(ui, new File(['\uFEFF {"sky": 2}'], 'view'));
  assert.equal(ui.settings.sky, 2);
  await openFile(ui, new File(['{"keys": [{"time": 0, "eye": [0, 0, 1], "target": [0, 0, 0]}]}'], 'path.json'));
  assert.equal(ui.settings.path.length, 1);
  ui.toasts.length = 0;
  await openFile(ui, new File(['{"sky": "high"}'], 'a.json'));
  await openFile(ui, new File(['sky'], 'b.json'));
  await openFile(ui, new File(['{"sky": 2, "moon": 1}'], 'c.json'));
  ui.viewer.open = () => Promise.reject(new Error('This file is damaged. It has 3 bytes.'));
  await openFile(ui, new File(['abc'], 'd.vdag'));
  assert.deepEqual(ui.toasts.filter((text) => text !== 'Settings loaded').map((text) => text.replace(/not JSON: .*/, 'not JSON')), [
    'a.json: "sky" is not a number', 'b.json: not JSON', 'c.json: loaded without the unknown keys moon', 'd.vdag: This file is damaged. It has 3 bytes.']);
});

test('another scene keeps the light, and nothing of the places of the scene before', () => {
  const before = mergeSettings(DEFAULTS, { sky: 2, measures: [{ from: [0, 0, 0], to: [1, 0, 0] }], section: { plane: { point: [0, 0, 0], normal: [1, 0, 0] } } });
  assert.deepEqual(mergeSettings(before, NO_PLACES), { ...DEFAULTS, sky: 2 });
});
