/** Two threads make the bytes that one makes, in the program for browsers. VOXDAG_MODULE names its voxdag.js. */
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { it } from 'node:test';

delete globalThis.fetch;  // the module would load its file from the web
const makeModule = createRequire(import.meta.url)(process.env.VOXDAG_MODULE);

/** A waved surface of coloured triangles. */
function coloredPly(rows = 64) {
  const vertices = [], faces = [];
  for (let j = 0; j <= rows; ++j) for (let i = 0; i <= rows; ++i) {
    const u = i / rows, v = j / rows, at = j * (rows + 1) + i;
    vertices.push(`${u} ${0.25 * Math.sin(9 * u) * Math.cos(7 * v)} ${v} ${Math.round(255 * u)} ${Math.round(255 * v)} ${(i * j) % 256}`);
    if (i < rows && j < rows) faces.push(`3 ${at} ${at + rows + 1} ${at + 1}`, `3 ${at + 1} ${at + rows + 1} ${at + rows + 2}`);
  }
  return `ply\nformat ascii 1.0\nelement vertex ${vertices.length}\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n` +
    `property uchar green\nproperty uchar blue\nelement face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n${vertices.join('\n')}\n${faces.join('\n')}\n`;
}
const cloud = Array.from({ length: 30000 }, (_, i) => `${Math.sin(i)} ${Math.cos(i * 1.7)} ${i / 15000}`).join('\n');

const LINES = [
  'scene sponge -o sponge.ply',
  'build sponge.ply -r 256 -o sponge.vdag', 'build sponge.ply -r 128 --solid -o solid.vdag', 'build colored.ply -r 512 --color --normal -o colored.vdag',
  'import cloud.xyz -r 256 -o cloud.vdag', 'convert colored.vdag --compact -o compact.vdag',
  'export colored.vdag -o colored.vox', 'import colored.vox -o again.vdag', 'export sponge.vdag -o sponge.glb'];

/** Runs the command lines with threads. Returns how many worked, and the files. @param {number} threads */
async function filesOf(threads) {
  const lines = /** @type {string[]} */ ([]);
  const { FS, PThread, callMain } = await makeModule({ threads, print() {}, printErr: (/** @type {string} */ line) => lines.push(line) });
  FS.mkdir('/work');
  FS.chdir('/work');
  FS.writeFile('colored.ply', coloredPly());
  FS.writeFile('cloud.xyz', cloud);
  for (const line of LINES) assert.equal(callMain([...line.split(' '), '-q']), 0, `${line}: ${lines.join('\n')}`);
  const working = 1 + PThread.runningWorkers.length;
  PThread.terminateAllThreads();
  return { working, files: new Map(FS.readdir('.').filter((/** @type {string} */ name) => !name.startsWith('.')).map((/** @type {string} */ name) => [name, Buffer.from(FS.readFile(name))])) };
}

it('makes the same bytes with one, two and five threads', { timeout: 500_000 }, async () => {
  const one = await filesOf(1);
  assert.equal(one.working, 1);
  assert.ok(one.files.size >= LINES.length);
  for (const threads of [2, 5]) {
    const { working, files } = await filesOf(threads);
    assert.equal(working, threads);
    assert.deepEqual([...files.keys()], [...one.files.keys()]);
    for (const [name, bytes] of files) assert.ok(bytes.equals(one.files.get(name)), `${name} with ${threads} threads`);
  }
});
