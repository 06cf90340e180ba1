import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { Zip, crc32 } from '../../apps/viewer/page/file/zip.js';

test('the checksum is that of ZIP: the check value of CRC-32', () => {
  assert.equal(crc32(new TextEncoder().encode('123456789')), 0xcbf43926);
  assert.equal(crc32(new Uint8Array()), 0);
});

test('another program reads the files of a ZIP', async (t) => {
  const files = { 'frame_0000.png': Uint8Array.from({ length: 1000 }, (_, i) => (i * 7) & 255), 'frame_0001.png': new Uint8Array(), 'ä.txt': new Uint8Array([65, 66]) };
  const zip = new Zip();
  for (const [name, bytes] of Object.entries(files)) await zip.add(name, new Blob([bytes]));
  const folder = mkdtempSync(path.join(tmpdir(), 'voxdag-zip-')), file = path.join(folder, 'a.zip');
  t.after(() => rmSync(folder, { recursive: true }));
  writeFileSync(file, Buffer.from(await zip.finish().arrayBuffer()));
  const script = 'import json, sys, zipfile\nz = zipfile.ZipFile(sys.argv[1])\nassert z.testzip() is None\n' +
    'print(json.dumps({n: list(z.read(n)) for n in z.namelist()}))';
  const read = JSON.parse(execFileSync('python3', ['-c', script, file], { encoding: 'utf8' }));
  assert.deepEqual(read, Object.fromEntries(Object.entries(files).map(([name, bytes]) => [name, [...bytes]])));
});
