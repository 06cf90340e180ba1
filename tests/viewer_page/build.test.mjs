import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { expected } from '../../apps/viewer/page/build/estimate.js';
import { kindOf, kindOfName, mainFile } from '../../apps/viewer/page/build/input_kinds.js';
import { isZip, unzip } from '../../apps/viewer/page/file/unzip.js';
import { Zip } from '../../apps/viewer/page/file/zip.js';
import { errorLine, plainLine } from '../../apps/viewer/page/build/program.js';

/** A ZIP that Python deflates, as programs of people do. */
const deflated = new Blob([execFileSync('python3', ['-c', 'import io, sys, zipfile\nb = io.BytesIO()\nz = zipfile.ZipFile(b, "w", zipfile.ZIP_DEFLATED)\n' +
  'z.writestr("house/", "")\nz.writestr("house/a.obj", "v 1 2 3\\n" * 5000)\nz.writestr("house/ä.mtl", "newmtl a\\n")\nz.writestr("empty.txt", "")\nz.close()\nsys.stdout.buffer.write(b.getvalue())'])]);

test('the files of a ZIP that another program wrote', async () => {
  const files = await unzip(deflated);
  assert.ok(await isZip(deflated));
  assert.deepEqual(files.map(({ name, data }) => [name, data.size]), [['house/a.obj', 40000], ['house/ä.mtl', 9], ['empty.txt', 0]]);
  assert.equal(await files[0].data.text(), 'v 1 2 3\n'.repeat(5000));
  assert.deepEqual((await unzip(deflated, (name) => name.endsWith('.mtl'))).map(({ name }) => name), ['house/ä.mtl']);
});

test('a ZIP that was cut off or changed is refused at every byte', async () => {
  const bytes = new Uint8Array(await deflated.arrayBuffer()), whole = await unzip(deflated);
  for (let length = 0; length < bytes.length; length += 7) await assert.rejects(unzip(new Blob([bytes.slice(0, length)])), /damaged/);
  for (let at = 0; at < bytes.length; at += 5) {
    const changed = bytes.slice();
    changed[at] ^= 0x55;
    const files = await unzip(new Blob([changed])).catch((error) => { assert.ok(error instanceof Error); return null; });
    // What a reader may ignore: times, versions, attributes and names.
    if (files) for (const { data } of files) assert.ok(whole.some((file) => file.data.size === data.size), `byte ${at}`);
  }
});

test('a ZIP with a file outside of its folder is refused', async () => {
  const zip = new Zip();
  await zip.add('../a.obj', new Blob(['v 1 2 3']));
  await assert.rejects(unzip(zip.finish()), /outside of its folder/);
});

test('names and heads say what a file is', async () => {
  assert.deepEqual(['a.OBJ', 'b.stl.gz', 'c.vox', 'd.nii.gz', 'e.xyz', 'f.vdag', 'g.png', 'h'].map(kindOfName), ['mesh', 'mesh', 'voxels', 'volume', 'points', null, null, null]);
  const of = (/** @type {string} */ name, /** @type {string} */ text) => kindOf({ name, data: new Blob([text]) });
  assert.equal(await of('a.ply', 'ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\nend_header\n'), 'mesh');
  assert.equal(await of('a.ply', 'ply\nformat ascii 1.0\nelement vertex 3\nelement face 0\nend_header\n'), 'points');
  const npy = (/** @type {string} */ type, /** @type {string} */ shape) => of('a.npy', `\x93NUMPY\x01\x00v\x00{'descr': '${type}', 'fortran_order': False, 'shape': (${shape}), }`);
  assert.deepEqual([await npy('<f4', '64, 64, 64'), await npy('<f4', '9, 3'), await npy('<i4', '9, 3')], ['volume', 'points', 'voxels']);
});

test('the largest mesh of a folder is built; without meshes voxels, volumes, points', () => {
  const file = (/** @type {string} */ name, /** @type {number} */ size) => ({ name, data: new Blob(['x'.repeat(size)]) });
  const files = [file('a/readme.txt', 90), file('a/small.obj', 10), file('a/large.ply', 20), file('a/b.png', 99)];
  assert.deepEqual([mainFile(files)?.main.name, mainFile(files)?.others], ['a/large.ply', 1]);
  assert.equal(mainFile([files[0], file('a.vox', 1)])?.main.name, 'a.vox');
  assert.equal(mainFile([files[3]]), null);
});

test('each doubling has four times the voxels', () => {
  const done = { resolution: 128, voxels: 1e4, seconds: 1, bytes: 2e7, hasColors: false };
  const at = (/** @type {number} */ resolution, colors = false) => expected(done, resolution, { colors, solid: false });
  assert.deepEqual([at(128), at(256).voxels, at(1024).voxels], [{ voxels: 1e4, seconds: 1, bytes: 2e7 }, 4e4, 64e4]);
  assert.ok(at(8192, true).bytes > at(8192).bytes && at(8192, true).seconds > at(8192).seconds);
  assert.ok(Number.isNaN(expected(done, 512, { colors: false, solid: true }).voxels));
});

test('a failure is one line, without folders of the program', () => {
  assert.equal(errorLine(['voxdag: warning: /in/a.obj: 3 triangles', 'voxdag: /in/x/a.obj: line 3: not a number']), 'x/a.obj: line 3: not a number');
  assert.equal(errorLine([]), null);
  assert.equal(plainLine('voxdag: warning: /in/a.obj: 3 triangles'), 'a.obj: 3 triangles');
});
