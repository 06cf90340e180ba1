/** A mesh in arrays as a binary PLY, which the program reads. */

/** Throws Error if the arrays do not fit together. @param {import('./index.js').Mesh} mesh */
function check({ positions, indices, colors }) {
  const vertices = positions.length / 3;
  if (!Number.isInteger(vertices)) throw new Error(`positions has ${positions.length} numbers; it needs three for each vertex`);
  if (!indices && vertices % 3 !== 0) throw new Error(`positions has ${positions.length} numbers; without indices it needs nine for each triangle`);
  if (indices && indices.length % 3 !== 0) throw new Error(`indices has ${indices.length} numbers; it needs three for each triangle`);
  if (colors && colors.length !== positions.length) throw new Error(`colors has ${colors.length} numbers; it needs ${positions.length}, three for each vertex`);
  const isWrong = (/** @type {number} */ index) => !(Number.isInteger(index) && index >= 0 && index < vertices);
  const at = indices ? Array.prototype.findIndex.call(indices, isWrong) : -1;
  if (at >= 0) throw new Error(`indices[${at}] is ${indices?.[at]}; there are ${vertices} vertices`);
}

/** Returns the file. Throws Error if the arrays do not fit together. @param {import('./index.js').Mesh} mesh */
export function plyOf(mesh) {
  check(mesh);
  const { positions, indices, colors } = mesh;
  // Doubles keep the places of small voxels far from the origin.
  const isFloat = positions instanceof Float32Array, isByte = colors instanceof Uint8Array || colors instanceof Uint8ClampedArray;
  const size = isFloat ? 4 : 8, colorSize = !colors ? 0 : isByte ? 1 : 4, row = 3 * (size + colorSize);
  const vertices = new DataView(new ArrayBuffer((positions.length / 3) * row));
  for (let i = 0; i < positions.length; ++i) {
    const at = Math.floor(i / 3) * row, axis = i % 3;
    if (isFloat) vertices.setFloat32(at + axis * size, positions[i], true);
    else vertices.setFloat64(at + axis * size, positions[i], true);
    if (!colors) continue;
    if (isByte) vertices.setUint8(at + 3 * size + axis, colors[i]);
    else vertices.setFloat32(at + 3 * size + axis * colorSize, colors[i], true);
  }
  const corners = indices?.length ?? positions.length / 3, faces = new DataView(new ArrayBuffer((corners / 3) * 13));
  for (let i = 0; i < corners; ++i) {
    const at = Math.floor(i / 3) * 13;
    if (i % 3 === 0) faces.setUint8(at, 3);
    faces.setUint32(at + 1 + (i % 3) * 4, indices?.[i] ?? i, true);
  }
  const properties = (/** @type {string} */ type, /** @type {string[]} */ names) => names.map((name) => `property ${type} ${name}\n`).join('');
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${positions.length / 3}\n${properties(isFloat ? 'float' : 'double', ['x', 'y', 'z'])}` +
    `${colors ? properties(isByte ? 'uchar' : 'float', ['red', 'green', 'blue']) : ''}element face ${corners / 3}\nproperty list uchar uint vertex_indices\nend_header\n`;
  return new Blob([head, vertices, faces]);
}
