/**
 * The header, the chunk table and the metadata of a .vdag file (docs/format.md). Part of the
 * worker's script: see scene_loader.js.
 */

/** @typedef {{offset: number, length: number}} Chunk */
/** @typedef {Map<string, Chunk>} ChunkTable */

/** Reads a u64 that fits into a number exactly. @param {DataView} view @param {number} at @param {string} what */
function readSize(view, at, what) {
  const high = view.getUint32(at + 4, true);
  if (high >= 1 << 21) throw brokenFile(`${what} is too large: it has more than 53 bits.`);
  return high * 4294967296 + view.getUint32(at, true);
}

/**
 * Reads the container's header and chunk table.
 * @param {BlobSource | ServerSource} source @param {Uint8Array} head the first bytes
 * @returns {Promise<ChunkTable>}
 */
async function readChunkTable(source, head) {
  const size = source.size;
  if (size < FILE.headerBytes || head.length < FILE.headerBytes)
    throw brokenFile(`It has ${size} bytes; a .vdag file begins with a header of ${FILE.headerBytes} bytes.`);
  FILE.magic.forEach((byte, i) => {
    if (head[i] !== byte) throw new SceneError('This is not a .vdag file', 'It does not begin with the bytes of a .vdag file.');
  });
  let view = new DataView(head.buffer, head.byteOffset, head.length);
  const version = view.getUint32(FILE.header.version, true), count = view.getUint32(FILE.header.chunkCount, true);
  if (version !== FILE.version)
    throw new SceneError('This file is of another version', `It has version ${version} of the format; this page reads version ${FILE.version}.`);
  if (count > FILE.maxChunks) throw brokenFile(`Its header announces ${count} chunks; at most ${FILE.maxChunks} are possible.`);
  const fileBytes = readSize(view, FILE.header.fileBytes, 'The size in the header');
  if (fileBytes !== size) throw brokenFile(`It has ${size} bytes, but its header says ${fileBytes}: it was cut off or never finished.`);
  const tableEnd = FILE.headerBytes + FILE.chunkEntryBytes * count;
  if (tableEnd > size) throw brokenFile('It ends inside its chunk table.');
  if (tableEnd > head.length) {
    head = new Uint8Array(tableEnd);
    await source.read(head, 0);
    view = new DataView(head.buffer);
  }
  /** @type {ChunkTable} */
  const chunks = new Map();
  const known = new Set(Object.keys(FILE.ids));
  let end = tableEnd;
  for (let i = 0; i < count; ++i) {
    const at = FILE.headerBytes + FILE.chunkEntryBytes * i;
    const id = String.fromCharCode(...head.subarray(at + FILE.chunkEntry.id, at + FILE.chunkEntry.id + 4)).replace(/[^\x20-\x7e]/g, '?');
    const isRequired = (view.getUint32(at + FILE.chunkEntry.flags, true) & FILE.requiredFlag) !== 0;
    const offset = readSize(view, at + FILE.chunkEntry.offset, `The offset of chunk ${id}`), length = readSize(view, at + FILE.chunkEntry.length, `The length of chunk ${id}`);
    const expected = Math.ceil(end / FILE.alignment) * FILE.alignment;
    if (offset !== expected) throw brokenFile(`Chunk ${id} begins at byte ${offset}; it should begin at byte ${expected}.`);
    if (offset + length > size) throw brokenFile(`Chunk ${id} goes on behind the end of the file.`);
    if (chunks.has(id)) throw brokenFile(`It has two chunks ${id}.`);
    if (!known.has(id) && isRequired) throw new SceneError('This file needs a newer page', `It has a chunk ${id}, which this page cannot read.`);
    chunks.set(id, { offset, length });
    end = offset + length;
  }
  return chunks;
}

/** Returns `object[key]`, which must be of `type`. @param {any} object @param {string} key @param {'number'|'object'} type @returns {any} */
function member(object, key, type) {
  const value = object === null || typeof object !== 'object' ? undefined : object[key];
  if (typeof value !== type || value === null || (type === 'number' && !Number.isFinite(value)))
    throw brokenFile(`Its metadata has no valid “${key}”.`);
  return value;
}

/**
 * Reads the metadata and the places of the levels.
 * @param {BlobSource | ServerSource} source @param {Uint8Array} head @param {ChunkTable} chunks
 */
async function readSceneInfo(source, head, chunks) {
  const meta = chunks.get('META'), levl = chunks.get('LEVL'), nodes = chunks.get('NODE'), leaves = chunks.get('LEAF');
  if (chunks.has('ESVO')) throw new SceneError('This file holds an ESVO', 'The viewer shows DAGs. Build one with `voxdag build MESH -r N -o scene.vdag`.');
  if (chunks.has('CHED')) throw new SceneError('This file has the compact form', 'Convert it with `voxdag convert FILE --plain -o scene.vdag`, or open it with `voxdag view`.');
  if (!meta || !levl || !nodes || !leaves) throw brokenFile('It lacks one of the chunks META, LEVL, NODE and LEAF.');
  if (meta.length > FILE.maxMetadataBytes) throw brokenFile(`Its metadata has ${meta.length} bytes; at most ${FILE.maxMetadataBytes} are possible.`);
  const json = await readPart(source, head, meta);
  /** @type {any} */
  let parsed;
  try {
    parsed = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(json));
  } catch {
    throw brokenFile('Its metadata is not JSON.');
  }
  const grid = member(parsed, 'grid', 'object'), counts = member(parsed, 'counts', 'object');
  const levels = member(grid, 'levels', 'number');
  const voxelSize = member(grid, 'voxel_size', 'number');
  const origin = member(grid, 'origin', 'object');
  if (!Number.isInteger(levels) || levels < DAG.minLevels || levels > DAG.maxLevels) throw brokenFile(`Its grid has ${levels} levels.`);
  if (!(voxelSize > 0)) throw brokenFile('The size of its voxels is not positive.');
  if (!Array.isArray(origin) || origin.length !== 3 || !origin.every(Number.isFinite)) throw brokenFile('Its metadata has no valid “origin”.');
  if (levl.length !== 8 * (levels - 1)) throw brokenFile(`Chunk LEVL has ${levl.length} bytes instead of ${8 * (levels - 1)}.`);
  if (nodes.length % 4 !== 0) throw brokenFile('Chunk NODE does not hold whole words.');
  if (leaves.length % 8 !== 0) throw brokenFile('Chunk LEAF does not hold whole blocks.');
  const table = await readPart(source, head, levl);
  const view = new DataView(table.buffer, table.byteOffset, table.length);
  /** @type {number[]} */
  const levelBegin = [];
  for (let l = 0; l < levels - 1; ++l) {
    levelBegin.push(readSize(view, 8 * l, 'A number in LEVL'));
    if (l === 0 ? levelBegin[0] !== 0 : levelBegin[l] < levelBegin[l - 1]) throw brokenFile(`The levels in LEVL do not follow each other (level ${l}).`);
  }
  const words = levelBegin[levels - 2];
  if (words * 4 !== nodes.length) throw brokenFile(`Chunk NODE has ${nodes.length / 4} words, but LEVL says ${words}.`);
  const leafBlocks = leaves.length / 8;
  const isEmpty = leafBlocks === 0;
  if (levels > 2 && (words === 0) !== isEmpty) throw brokenFile('Only one of its chunks NODE and LEAF is empty.');
  if (words >= 2 ** 32 || leafBlocks >= 2 ** 32) throw brokenFile('It has more nodes than pointers of 32 bits reach.');
  const list = (/** @type {any} */ values) => (Array.isArray(values) ? values.filter(Number.isFinite) : []);
  return {
    levels, resolution: 2 ** levels, origin: /** @type {[number, number, number]} */ (origin.slice()), voxelSize,
    voxels: Number(counts.voxels) || 0,
    dagNodesPerLevel: list(counts.dag_nodes_per_level),
    fileBytes: source.size, isEmpty, words, leafBlocks, levelBegin,
    hasColors: (chunks.has('COLR') || chunks.has('WCOL')) && chunks.has('CIDX'),
    materials: chunks.has('MTID') && chunks.has('CIDX') ? namesIn(parsed.attributes?.material?.names) : null,
    channels: chunks.has('CHAN') && chunks.has('CIDX') ? await readChannelList(source, head, /** @type {Chunk} */ (chunks.get('CHAN'))) : [],
    hasNormals: (chunks.has('NRML') || chunks.has('WNRM')) && chunks.has('CIDX'),
    up: ['x', 'y', 'z'].includes(parsed.up) ? parsed.up : null, unit: ['mm', 'cm', 'm', 'in', 'ft'].includes(parsed.unit) ? parsed.unit : null, home: homeIn(parsed.home), cubes: parsed.cubes === true,
    source: { name: String(parsed.source?.name ?? ''), vertices: Number(parsed.source?.vertices) || 0, triangles: Number(parsed.source?.triangles) || 0 },
  };
}

/** Returns the names of materials, by id. @param {any} names @returns {string[]} */
const namesIn = (names) => (Array.isArray(names) ? names.map(String) : []);

/** Returns the home view of the metadata, or null if it is no view. @param {any} home */
function homeIn(home) {
  const isPoint = (/** @type {any} */ p) => Array.isArray(p) && p.length === 3 && p.every(Number.isFinite);
  const isView = home && isPoint(home.eye) && isPoint(home.target) && isPoint(home.up) && home.fov > 0 && home.fov < 180;
  if (!isView) return null;
  return { eye: home.eye, target: home.target, up: home.up, fov: home.fov, ...(isPoint(home.sun) ? { sun: home.sun } : {}) };
}

/** Returns the bytes of a chunk, from `head` if they are in it. @param {BlobSource | ServerSource} source @param {Uint8Array} head @param {Chunk} chunk */
async function readPart(source, head, chunk) {
  if (chunk.offset + chunk.length <= head.length) return head.slice(chunk.offset, chunk.offset + chunk.length);
  const bytes = new Uint8Array(chunk.length);
  await source.read(bytes, chunk.offset);
  return bytes;
}
