/**
 * Checks levels of a DAG, so that nothing that the graphics card reads leads outside the DAG. Part
 * of the worker's script: see scene_loader.js.
 */

/** @param {number} mask */
function countBits8(mask) {
  mask = mask - ((mask >> 1) & 0x55);
  mask = (mask & 0x33) + ((mask >> 2) & 0x33);
  return (mask + (mask >> 4)) & 0x0f;
}

/** Whether the instances of nodes of a level are counted: not for levels of more words. */
const MOST_COUNTED_WORDS = 1 << 25;

/**
 * The level above the one that is checked next: its words, and how many cells of the octree each of
 * its nodes stands for.
 * @typedef {{level: number, words: Uint32Array, instances: Float32Array | null}} UpperLevel
 */

/** Codes a number of instances: INSTANCE_STEPS * log2, rounded. @param {Float32Array} counts @returns {Uint8Array} */
function codeInstances(counts) {
  const codes = new Uint8Array(counts.length);
  for (let i = 0; i < counts.length; ++i)
    if (counts[i] > 1) codes[i] = Math.min(255, Math.round(INSTANCE_STEPS * Math.log2(counts[i])));
  return codes;
}

/**
 * Counts the instances of the nodes of a level from those of the level above, and checks all
 * pointers to it. `isNode(i)` tells whether a node begins at word (or block) i of the level.
 * @param {UpperLevel} above @param {number} begin of the level: pointers count from 0
 * @param {number} count words or blocks of the level @param {(i: number) => boolean} isNode
 * @returns {Float32Array | null}
 */
function followPointers(above, begin, count, isNode) {
  const { words, level } = above;
  const instances = above.instances !== null && count <= MOST_COUNTED_WORDS ? new Float32Array(count) : null;
  for (let at = 0; at < words.length; ) {
    const children = countBits8(words[at]);
    const parents = above.instances === null ? 1 : above.instances[at];
    for (let c = 1; c <= children; ++c) {
      const target = words[at + c] - begin;
      if (!(target >= 0 && target < count) || !isNode(target))
        throw brokenFile(`A node of level ${level} points to word ${words[at + c]}, where no node of level ${level + 1} begins.`);
      if (instances !== null) instances[target] += parents;
    }
    at += 1 + children;
  }
  return instances;
}

/**
 * Checks the nodes of a level and the pointers to them.
 * @param {number} level @param {number} begin its first word in NODE @param {Uint32Array} words @param {UpperLevel | null} above
 * @returns {UpperLevel}
 */
function checkLevel(level, begin, words, above) {
  const starts = new Uint8Array((words.length + 7) >> 3);
  let at = 0;
  while (at < words.length) {
    const mask = words[at];
    if (mask === 0 || mask > 255) throw brokenFile(`Word ${begin + at} of NODE, a node of level ${level}, is no child mask.`);
    starts[at >> 3] |= 1 << (at & 7);
    at += 1 + countBits8(mask);
  }
  if (at !== words.length) throw brokenFile(`The last node of level ${level} goes on behind the end of the level.`);
  if (above === null) {
    if (words.length > 0 && words.length !== 1 + countBits8(words[0])) throw brokenFile('Level 0 has more than one node.');
    return { level, words, instances: new Float32Array(words.length).fill(1) };
  }
  const instances = followPointers(above, begin, words.length, (i) => ((starts[i >> 3] >> (i & 7)) & 1) !== 0);
  return { level, words, instances };
}

/**
 * Checks the leaf blocks and the pointers to them. Returns their instances.
 * @param {number} level L-2 @param {Uint32Array} halves two words per block @param {UpperLevel | null} above
 * @returns {Float32Array | null}
 */
function checkLeaves(level, halves, above) {
  const count = halves.length / 2;
  for (let i = 0; i < count; ++i)
    if (halves[2 * i] === 0 && halves[2 * i + 1] === 0) throw brokenFile(`Leaf block ${i} is empty.`);
  if (above === null) {
    if (count > 1) throw brokenFile('Level 0 has more than one leaf block.');
    return new Float32Array(count).fill(1);
  }
  return followPointers(above, 0, count, () => true);
}
