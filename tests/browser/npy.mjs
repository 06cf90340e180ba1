/** NumPy files of rays and hits, as `voxdag trace` reads and writes them. */
import fs from 'node:fs';

/** @param {string} path @param {Float32Array} values @param {number} columns */
export function writeNpy(path, values, columns) {
  const text = `{'descr': '<f4', 'fortran_order': False, 'shape': (${values.length / columns}, ${columns}), }`;
  const header = text.padEnd(Math.ceil((text.length + 11) / 64) * 64 - 11) + '\n';
  const head = Buffer.alloc(10);
  head.write('\x93NUMPY\x01\x00', 'latin1');
  head.writeUInt16LE(header.length, 8);
  fs.writeFileSync(path, Buffer.concat([head, Buffer.from(header, 'latin1'), Buffer.from(values.buffer)]));
}

/**
 * Reads the hits of `voxdag trace`: t, voxel, face, hit.
 * @param {string} path @returns {{t: number, voxel: number[], face: number, hit: boolean}[]}
 */
export function readHits(path) {
  const bytes = fs.readFileSync(path), begin = 10 + bytes.readUInt16LE(8);
  const header = bytes.toString('latin1', 10, begin);
  const rowBytes = [...header.matchAll(/'[<|]([fiu])(\d)'(?:, \((\d),\))?/g)].reduce((sum, [, , size, count]) => sum + Number(size) * Number(count ?? 1), 0) +
      (header.includes("'|b1'") ? 1 : 0);
  const hits = [];
  for (let at = begin; at + rowBytes <= bytes.length; at += rowBytes)
    hits.push({ t: bytes.readFloatLE(at), voxel: [4, 8, 12].map((o) => bytes.readInt32LE(at + o)), face: bytes.readInt8(at + 16), hit: bytes[at + 17] !== 0 });
  return hits;
}
