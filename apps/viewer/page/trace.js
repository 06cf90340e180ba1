/**
 * Casts rays at the copy of the DAG in memory: for picking, and for walking. The port of
 * trace/cast.hpp; numbers are rounded to float where that file uses floats, so that hits are equal.
 */

/** @typedef {import('./math.js').Vec3} Vec3 */
/** @typedef {import('./viewer_types.js').Hit} Hit */
/**
 * The DAG in memory: levels of cells that have arrived.
 * @typedef {{levels: number, shown: number, origin: Vec3, voxelSize: number, nodes: Uint32Array, leaves: Uint32Array, root?: number}} Dag  root: 0 if left out; NO_NODE: no voxels.
 */

/** The root of a DAG without voxels. */
export const NO_NODE = 0xffffffff;

const floats = new Float32Array(1), bitsOf = new Uint32Array(floats.buffer);
const f32 = Math.fround;

/** @param {number} bits */
function floatOf(bits) {
  bitsOf[0] = bits;
  return floats[0];
}

/** Returns the bits of 8 that are set. @param {number} v */
export function bitCount(v) {
  v = v - ((v >> 1) & 0x55);
  v = (v & 0x33) + ((v >> 2) & 0x33);
  return (v + (v >> 4)) & 0x0f;
}

/** @param {number} half @returns {number} bit i is set if byte i is not zero */
function bytesOf(half) {
  return (half & 0xff ? 1 : 0) | (half & 0xff00 ? 2 : 0) | (half & 0xff0000 ? 4 : 0) | (half & 0xff000000 ? 8 : 0);
}

/** @param {Dag} dag @param {number} node @param {number} level */
export function childMask(dag, node, level) {
  if (level < dag.levels - 2) return dag.nodes[node] & 0xff;
  if (level === dag.levels - 1) return node;
  return bytesOf(dag.leaves[2 * node]) | (bytesOf(dag.leaves[2 * node + 1]) << 4);
}

/** @param {Dag} dag @param {number} node @param {number} level @param {number} index */
export function childOf(dag, node, level, index) {
  if (level < dag.levels - 2) return dag.nodes[node + 1 + bitCount(dag.nodes[node] & ((1 << index) - 1))];
  return (dag.leaves[2 * node + (index >> 2)] >>> (8 * (index & 3))) & 0xff;
}

/**
 * Returns the first cell along a ray in world units, or null.
 * @param {Dag} dag @param {Vec3} from @param {Vec3} direction @param {number} [most] longest distance
 * @param {((voxel: Vec3, level: number) => boolean) | null} [isLeftOut]  Whether rays pass through a cell.
 * @returns {Hit | null}
 */
export function cast(dag, from, direction, most = Infinity, isLeftOut = null) {
  const { root = 0 } = dag;
  if (dag.shown < 1 || root === NO_NODE) return null;
  const side = dag.voxelSize * 2 ** dag.levels;
  const start = [0, 1, 2].map((a) => (from[a] - dag.origin[a]) / side);
  let d = [0, 1, 2].map((a) => direction[a] / side);
  const length = Math.max(...d.map(Math.abs));
  if (!(length > 0 && Number.isFinite(length) && start.every(Number.isFinite))) return null;
  d = d.map((x) => x / length);
  let enter = 0, leave = Infinity, enterAxis = -1, mirrored = 0, parallel = 0;
  const inverse = [4294967296, 4294967296, 4294967296];
  for (let a = 0; a < 3; ++a) {
    const still = Math.abs(d[a]) < 2 ** -32;
    if (still) {
      parallel |= 1 << a;
      mirrored |= 1 << a;
    }
    if (d[a] === 0) {
      if (!(start[a] >= 0 && start[a] < 1)) return null;
      continue;
    }
    const inv = 1 / d[a];
    const near = ((d[a] > 0 ? 0 : 1) - start[a]) * inv, far = ((d[a] > 0 ? 1 : 0) - start[a]) * inv;
    if (near > enter) {
      enter = near;
      enterAxis = a;
    }
    leave = Math.min(leave, far);
    if (still) continue;
    mirrored |= d[a] > 0 ? 1 << a : 0;
    inverse[a] = f32(Math.abs(inv));
  }
  if (!(enter <= leave)) return null;
  const o = [0, 0, 0];
  for (let a = 0; a < 3; ++a) {
    let p = start[a];
    if (a === enterAxis) p = d[a] > 0 ? 0 : 1;
    else if (enter !== 0) p += enter * d[a];
    let q = f32(1 + Math.min(1, Math.max(0, p)));
    if ((parallel >> a) & 1 && q > 2 - 2 ** -23) q = 2 - 2 ** -23;
    o[a] = (mirrored >> a) & 1 ? f32(3 - q) : q;
  }
  const tStart = enter / length, tScale = 1 / length;
  const tMax = most * length - enter;
  const plane = (/** @type {number} */ a, /** @type {number} */ bits) => f32(f32(o[a] - floatOf(bits)) * inverse[a]);

  let t = 0;
  const corner = [0x3f800000, 0x3f800000, 0x3f800000];
  if (Math.min(plane(0, corner[0]), plane(1, corner[1]), plane(2, corner[2])) <= t || tMax < 0) return null;
  /** @type {number[]} */
  const stack = [];
  let node = root, mask = childMask(dag, root, 0), bit = 22, child = 0;
  const select = () => {
    child = 0;
    for (let a = 0; a < 3; ++a)
      if (plane(a, corner[a] | (1 << bit)) > t) {
        corner[a] |= 1 << bit;
        child |= 1 << a;
      }
  };
  select();
  for (;;) {
    const px = plane(0, corner[0]), py = plane(1, corner[1]), pz = plane(2, corner[2]);
    const exit = Math.min(px, py, pz);
    const index = child ^ mirrored;
    if ((mask >> index) & 1) {
      const level = 23 - bit;
      if (level < dag.shown) {
        stack[level - 1] = node;
        node = childOf(dag, node, level - 1, index);
        mask = childMask(dag, node, level);
        --bit;
        select();
        continue;
      }
      const hit = toHit(level);
      if (!isLeftOut?.(hit.voxel, level)) return hit;
    }
    if (exit > tMax) return null;
    t = exit;
    let changed = 0;
    [px, py, pz].forEach((p, a) => {
      if (p !== exit) return;
      const next = corner[a] - (1 << bit);
      changed |= corner[a] ^ next;
      corner[a] = next;
      child ^= 1 << a;
    });
    if (changed >>> bit === 1) continue;
    if (changed >= 0x800000) return null;
    bit = 31 - Math.clz32(changed);
    child = 0;
    for (let a = 0; a < 3; ++a) {
      corner[a] &= -1 << bit;
      child |= ((corner[a] >> bit) & 1) << a;
    }
    node = stack[22 - bit];
    mask = childMask(dag, node, 22 - bit);
  }

  /** @param {number} level @returns {Hit} */
  function toHit(level) {
    let face = -1;
    for (let a = 2; a >= 0; --a)
      if (!((parallel >> a) & 1) && plane(a, corner[a] + (1 << (23 - level))) === t) face = 2 * a + ((mirrored >> a) & 1 ? 0 : 1);
    const size = 2 ** (dag.levels - level);
    const voxel = corner.map((c, a) => {
      const low = ((c & 0x7fffff) >>> (23 - level)) * size;
      return (mirrored >> a) & 1 ? 2 ** dag.levels - size - low : low;
    });
    const distance = Math.max(0, tStart + t * tScale);
    const position = [0, 1, 2].map((a) => from[a] + direction[a] * distance);
    return { voxel: /** @type {Vec3} */ (voxel), level, face, distance, position: /** @type {Vec3} */ (position) };
  }
}

/** Returns whether a point in world units is in a set cell. @param {Dag} dag @param {Vec3} point */
export function contains(dag, point) {
  if (dag.shown < 1 || dag.root === NO_NODE) return false;
  const side = 2 ** dag.levels;
  const voxel = point.map((p, a) => Math.floor((p - dag.origin[a]) / dag.voxelSize));
  if (voxel.some((v) => !(v >= 0 && v < side))) return false;
  let node = dag.root ?? 0;
  for (let level = 0; level < dag.shown; ++level) {
    const shift = dag.levels - 1 - level;
    const index = voxel.reduce((sum, v, a) => sum | (((v >>> shift) & 1) << a), 0);
    if (!((childMask(dag, node, level) >> index) & 1)) return false;
    if (level + 1 < dag.shown) node = childOf(dag, node, level, index);
  }
  return true;
}

/**
 * Returns bounds of the set cells in world units, from the cells of at most `level`.
 * @param {Dag} dag @param {number} level @returns {{low: Vec3, high: Vec3} | null}
 */
export function bounds(dag, level) {
  const depth = Math.min(level, dag.shown);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  /** @param {number} node @param {number} l @param {number[]} at */
  const visit = (node, l, at) => {
    const size = 2 ** -l;
    if (at.every((p, a) => p >= low[a] && p + size <= high[a])) return;
    if (l === depth) {
      at.forEach((p, a) => {
        low[a] = Math.min(low[a], p);
        high[a] = Math.max(high[a], p + size);
      });
      return;
    }
    const mask = childMask(dag, node, l);
    for (let i = 0; i < 8; ++i)
      if ((mask >> i) & 1) visit(l + 1 < depth ? childOf(dag, node, l, i) : 0, l + 1, at.map((p, a) => p + ((i >> a) & 1) * (size / 2)));
  };
  if (depth >= 1 && dag.root !== NO_NODE) visit(dag.root ?? 0, 0, [0, 0, 0]);
  if (!(low[0] <= high[0])) return null;
  const side = dag.voxelSize * 2 ** dag.levels;
  const world = (/** @type {number[]} */ p) => /** @type {Vec3} */ (p.map((x, a) => dag.origin[a] + x * side));
  return { low: world(low), high: world(high) };
}

/**
 * Returns the likely up vector: y or z. The port of guess_up() of render/coarse_cells.cpp, from the cells of at most level 7.
 * @param {Dag} dag @returns {Vec3}
 */
export function guessUp(dag) {
  const depth = Math.min(7, dag.shown), side = 2 ** depth;
  /** @type {number[][]} */
  const cells = [];
  /** @param {number} node @param {number} l @param {number[]} at */
  const visit = (node, l, at) => {
    if (l === depth) return void cells.push(at);
    const mask = childMask(dag, node, l);
    for (let i = 0; i < 8; ++i)
      if ((mask >> i) & 1) visit(l + 1 < depth ? childOf(dag, node, l, i) : 0, l + 1, at.map((p, a) => 2 * p + ((i >> a) & 1)));
  };
  if (dag.shown > 0) visit(0, 0, [0, 0, 0]);
  if (cells.length === 0) return [0, 1, 0];
  const low = [side, side, side], high = [0, 0, 0];
  for (const cell of cells)
    for (let a = 0; a < 3; ++a) {
      low[a] = Math.min(low[a], cell[a]);
      high[a] = Math.max(high[a], cell[a] + 1);
    }
  const [x, y, z] = high.map((h, a) => h - low[a]);
  if (z * 3 < Math.min(x, y)) return [0, 0, 1];
  if (y * 3 < Math.min(x, z)) return [0, 1, 0];
  const reach = Math.max(1, Math.floor(side / 40));
  /** Returns the part of the lower side along `axis` that cells cover. @param {number} axis */
  const cover = (axis) => {
    const u = (axis + 1) % 3, v = (axis + 2) % 3, covered = new Set();
    for (const cell of cells) if (cell[axis] - low[axis] < reach) covered.add(cell[u] * side + cell[v]);
    return covered.size / ((high[u] - low[u]) * (high[v] - low[v]));
  };
  return cover(2) > 2.5 * cover(1) ? [0, 0, 1] : [0, 1, 0];
}
