/** The mesh of the npm package as a PLY. */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { plyOf } from '../../apps/npm/ply.js';

const TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0];

/** Returns the head of a file and its bytes behind it. @param {Blob} file */
async function parts(file) {
  const bytes = new Uint8Array(await file.arrayBuffer()), end = new TextDecoder('latin1').decode(bytes).indexOf('end_header\n') + 11;
  return { head: new TextDecoder().decode(bytes.subarray(0, end)), body: new DataView(bytes.buffer, end) };
}

test('floats stay floats, other numbers become doubles', async () => {
  const floats = await parts(plyOf({ positions: new Float32Array(TRIANGLE) })), doubles = await parts(plyOf({ positions: TRIANGLE.map((x) => x + 1e6 + 1e-6) }));
  assert.match(floats.head, /element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n/);
  assert.deepEqual([floats.body.byteLength, floats.body.getFloat32(12, true)], [3 * 12 + 13, 1]);
  assert.match(doubles.head, /property double x/);
  assert.deepEqual([doubles.body.byteLength, doubles.body.getFloat64(24, true)], [3 * 24 + 13, 1 + 1e6 + 1e-6]);
});

test('indices are faces; without them each three vertices are one', async () => {
  const { head, body } = await parts(plyOf({ positions: new Float32Array([...TRIANGLE, 0, 0, 1]), indices: new Uint16Array([0, 1, 2, 3, 2, 1]) }));
  assert.match(head, /element vertex 4\n[^]*element face 2\n/);
  const at = 4 * 12 + 13;
  assert.deepEqual([body.getUint8(at), ...[1, 5, 9].map((i) => body.getUint32(at + i, true))], [3, 3, 2, 1]);
  const plain = await parts(plyOf({ positions: new Float32Array(TRIANGLE), indices: null }));
  assert.deepEqual([1, 5, 9].map((i) => plain.body.getUint32(36 + i, true)), [0, 1, 2]);
});

test('colours are bytes, or numbers from 0 to 1', async () => {
  const colors = [255, 0, 128, 1, 2, 3, 4, 5, 6], bytes = await parts(plyOf({ positions: new Float32Array(TRIANGLE), colors: new Uint8Array(colors) }));
  assert.match(bytes.head, /property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n/);
  assert.deepEqual([12, 13, 14, 27].map((at) => bytes.body.getUint8(at)), [255, 0, 128, 1]);
  const floats = await parts(plyOf({ positions: new Float32Array(TRIANGLE), colors: colors.map((c) => c / 256) }));
  assert.match(floats.head, /property float red/);
  assert.equal(floats.body.getFloat32(20, true), 0.5);
});

test('arrays that do not fit together are refused with their name', () => {
  const positions = new Float32Array(TRIANGLE);
  for (const [mesh, message] of /** @type {[any, RegExp][]} */ ([
    [{ positions: [1, 2] }, /^positions has 2 numbers; it needs three for each vertex$/],
    [{ positions: [1, 2, 3] }, /^positions has 3 numbers; without indices it needs nine for each triangle$/],
    [{ positions, indices: [0, 1] }, /^indices has 2 numbers; it needs three for each triangle$/],
    [{ positions, indices: [0, 1, 3] }, /^indices\[2\] is 3; there are 3 vertices$/],
    [{ positions, indices: [0, 0.5, 1] }, /^indices\[1\] is 0\.5/],
    [{ positions, indices: [0, -1, 1] }, /^indices\[1\] is -1/],
    [{ positions, colors: [1] }, /^colors has 1 numbers; it needs 9, three for each vertex$/]]))
    assert.throws(() => plyOf(mesh), { message });
});
