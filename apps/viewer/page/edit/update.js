/** What the server answers to an edit: see apps/viewer/edit/edit_update.hpp. */

/**
 * A run of words, or of blocks of two words, from number `first` on.
 * @typedef {{first: number, values: Uint32Array}} Run
 * @typedef {{writer: number, version: import('../scene_memory.js').Version, undos: number, redos: number, words: Run[], blocks: Run[], values: Run[]}} Update
 */

const HEAD_WORDS = 10;
/** Words or blocks of room behind those of an update: so that few updates need larger textures. */
const ROOM = 1 << 18;

/** @param {ArrayBuffer} bytes @returns {Update} */
export function parseUpdate(bytes) {
  const all = new Uint32Array(bytes), [writer, root, colors, normals, materials, undos, redos, ...counts] = all.subarray(0, HEAD_WORDS);
  let run = HEAD_WORDS, at = HEAD_WORDS + 2 * counts.reduce((sum, count) => sum + count, 0);
  const [words, blocks, values] = counts.map((count, kind) => Array.from({ length: count }, () => {
    const first = all[run++], size = all[run++] * (kind === 1 ? 2 : 1);
    return { first, values: all.subarray(at, (at += size)) };
  }));
  if (at !== all.length) throw new Error('the answer of the server is broken');
  return { writer, version: { root, colors, normals, materials }, undos, redos, words, blocks, values };
}

/** Returns the array with the runs: itself, or a larger one. @param {Uint32Array} array @param {number} per  Words of an element. @param {Run[]} runs */
export function withRuns(array, per, runs) {
  const end = runs.reduce((most, { first, values }) => Math.max(most, per * first + values.length), 0);
  let result = array;
  if (end > array.length) {
    result = new Uint32Array(per * (Math.ceil(1.25 * (end / per)) + ROOM));
    result.set(array);
  }
  for (const { first, values } of runs) result.set(values, per * first);
  return result;
}

/**
 * Brings an update into the scene's memory and textures. Throws Error if the card cannot hold it.
 * @param {Update} update @param {import('../scene_memory.js').SceneMemory} memory
 * @param {import('../gpu/scene_textures.js').SceneTextures} textures @param {number} most  Elements of a texture.
 */
export function applyUpdate({ version, words, blocks, values }, memory, textures, most) {
  const nodes = withRuns(memory.nodes, 1, words), leaves = withRuns(memory.leaves, 2, blocks), overlay = withRuns(memory.overlay, 1, values);
  if (nodes.length > most || leaves.length > 2 * most || overlay.length > most) throw new Error('The graphics card cannot hold more edits: save them, and open the file');
  const hasMoreNodes = nodes !== memory.nodes || leaves !== memory.leaves, hasMoreValues = overlay !== memory.overlay;
  Object.assign(memory, { nodes, leaves, overlay });
  if (hasMoreNodes) textures.setNodes(nodes, leaves);
  else {
    for (const run of words) textures.nodes.set(run.first, run.values);
    for (const run of blocks) textures.leaves.set(run.first, run.values);
  }
  if (hasMoreValues) textures.setOverlay(overlay);
  else for (const run of values) textures.overlay?.set(run.first, run.values);
  Object.assign(memory.version, version);
}
