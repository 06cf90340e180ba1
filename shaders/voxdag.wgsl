// Rays through a sparse voxel DAG, for WebGPU: voxdag.glsl, which explains the method, in WGSL.
//
// Declare, anywhere in the module, what this file reads: the words of the chunks NODE and LEAF of a plain .vdag file, as they are, and
// the levels of the grid, which has 2^voxdag_levels voxels a side; 0 if it has no voxels.
//
//   @group(0) @binding(0) var<storage, read> voxdag_nodes: array<u32>;
//   @group(0) @binding(1) var<storage, read> voxdag_leaves: array<vec2u>;
//   override voxdag_levels: i32;

const VOXDAG_MAX_LEVELS = 20;
const VOXDAG_LEAF_LEVELS = 2;  // a leaf block has 4^3 voxels
const VOXDAG_NO_FACE = -1;

// 48 bytes. voxdag_enter_grid() of voxdag.h makes exact ones on the CPU.
struct VoxdagRay {
  origin: vec3f,   // in [1,2], mirrored
  t_min: f32,      // the range of T
  inverse: vec3f,  // 1 / |component|; 2^32 on axes along which the ray does not move
  t_max: f32,
  mirrored: u32,   // a bit per axis
  parallel: u32,   // axes along which the ray does not move
  t_start: f32,    // the caller's parameter is t_start + t_scale * T
  t_scale: f32,
}

struct VoxdagHit {
  found: bool,
  t: f32,       // T where the ray enters the cell; t_min if it starts inside
  face: i32,    // -x, +x, -y, +y, -z, +z are 0 to 5; VOXDAG_NO_FACE if the ray starts inside
  level: i32,   // of the cell: voxdag_levels if it is a voxel
  cell: vec3u,  // its coordinates among the 2^level cells of each axis
}

// The eight children of a node: bit i is child i, x + 2 y + 4 z.
// A node is a word index (levels below L-2), the index of a leaf block (L-2), or its own mask (L-1).
fn voxdag_child_mask(node: u32, level: i32) -> u32 {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS) { return voxdag_nodes[node] & 0xFFu; }
  if (level == voxdag_levels - 1) { return node; }
  var block = voxdag_leaves[node];  // byte i is the mask of octant i
  block |= block >> vec2u(4u);
  block |= block >> vec2u(2u);
  block |= block >> vec2u(1u);
  block = ((block & vec2u(0x01010101u)) * 0x10204080u) >> vec2u(28u);
  return block.x | (block.y << 4u);
}

fn voxdag_child(node: u32, level: i32, index: u32) -> u32 {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS) {
    return voxdag_nodes[node + 1u + countOneBits(voxdag_nodes[node] & ((1u << index) - 1u))];
  }
  return (voxdag_leaves[node][index >> 2u] >> (8u * (index & 3u))) & 0xFFu;
}

// Returns whether the cell of a level, 0 to voxdag_levels, has voxels. Coordinates outside of the grid have none.
fn voxdag_contains(cell: vec3i, level: i32) -> bool {
  if (voxdag_levels == 0 || any((cell >> vec3u(u32(level))) != vec3i(0))) { return false; }
  var node = 0u;
  for (var l = 0; l < level; l++) {
    let bits = vec3u(cell >> vec3u(u32(level - 1 - l))) & vec3u(1u);
    let index = bits.x | (bits.y << 1u) | (bits.z << 2u);
    if (((voxdag_child_mask(node, l) >> index) & 1u) == 0u) { return false; }
    if (l + 1 < voxdag_levels) { node = voxdag_child(node, l, index); }
  }
  return true;
}

// Returns the ray of the points origin + t * direction, 0 <= t <= t_max. `origin` is relative to the grid's lower corner, in sides of
// the grid: (world - info.origin) / (info.voxel_size * info.resolution). It may lie anywhere. The direction, in any unit, need not have
// unit length. A ray that misses the grid has t_max < t_min.
fn voxdag_ray(origin: vec3f, direction: vec3f, t_max: f32) -> VoxdagRay {
  var ray = VoxdagRay(vec3f(1.0), 1.0, vec3f(1.0), 0.0, 7u, 0u, 0.0, 1.0);
  let size = abs(direction);
  let longest = max(max(size.x, size.y), size.z);
  if (!(longest > 0.0)) { return ray; }
  let d = direction / longest;
  var enter = 0.0;
  var leave = 3e38;
  var enter_axis = -1;
  var mirrored = 0u;
  var parallel = 0u;
  var inverse = vec3f(4294967296.0);
  for (var axis = 0; axis < 3; axis++) {
    let bit = 1u << u32(axis);
    if (abs(d[axis]) < 2.3283064e-10) {
      if (!(origin[axis] >= 0.0 && origin[axis] < 1.0)) { return ray; }
      parallel |= bit;
      mirrored |= bit;
      continue;
    }
    let i = 1.0 / d[axis];
    let near_t = (select(1.0, 0.0, d[axis] > 0.0) - origin[axis]) * i;
    let far_t = (select(0.0, 1.0, d[axis] > 0.0) - origin[axis]) * i;
    if (near_t > enter) {
      enter = near_t;
      enter_axis = axis;
    }
    leave = min(leave, far_t);
    if (d[axis] > 0.0) { mirrored |= bit; }
    inverse[axis] = abs(i);
  }
  if (!(enter <= leave)) { return ray; }
  for (var axis = 0; axis < 3; axis++) {
    var p = origin[axis];
    if (axis == enter_axis) {
      p = select(1.0, 0.0, d[axis] > 0.0);
    } else if (enter != 0.0) {
      p += enter * d[axis];
    }
    var q = 1.0 + clamp(p, 0.0, 1.0);
    if (((parallel >> u32(axis)) & 1u) != 0u) { q = min(q, 1.99999988); }
    ray.origin[axis] = select(q, 3.0 - q, ((mirrored >> u32(axis)) & 1u) != 0u);
  }
  ray.inverse = inverse;
  ray.mirrored = mirrored;
  ray.parallel = parallel;
  ray.t_scale = 1.0 / longest;
  ray.t_start = enter * ray.t_scale;
  ray.t_min = 0.0;
  ray.t_max = t_max * longest - enter;
  return ray;
}

// Finds the first voxel along a ray. With `stop`, the ray ends earlier, at the first cell with voxels whose side is at most
// stop.x + stop.y * T, in sides of the grid: for beams and level of detail. vec2f() finds voxels.
fn voxdag_cast(ray: VoxdagRay, stop: vec2f) -> VoxdagHit {
  var hit = VoxdagHit(false, 0.0, VOXDAG_NO_FACE, 0, vec3u(0u));
  let o = ray.origin;
  let inverse = ray.inverse;
  let leave = (o - vec3f(1.0)) * inverse;
  var t = ray.t_min;
  if (voxdag_levels == 0 || !(t <= ray.t_max) || min(min(leave.x, leave.y), leave.z) <= t) { return hit; }

  // The path to the parent of the current cell, and the cell that the ray is in at T: of level 23 - bit, with its lower corner as
  // float bits. Neighbours of its size differ in this bit of the corner.
  var stack: array<u32, VOXDAG_MAX_LEVELS>;
  var node = 0u;
  var mask = voxdag_child_mask(0u, 0);
  var corner = vec3u(0x3F800000u);
  var child = 0u;
  var bit = 23u;
  var descends = true;
  loop {
    if (descends) {  // to the child that the ray is in at T
      bit -= 1u;
      let up = vec3u((o - bitcast<vec3f>(corner | vec3u(1u << bit))) * inverse > vec3f(t));
      corner |= up << vec3u(bit);
      child = up.x | (up.y << 1u) | (up.z << 2u);
    }
    let planes = (o - bitcast<vec3f>(corner)) * inverse;
    let exit_t = min(min(planes.x, planes.y), planes.z);
    let index = child ^ ray.mirrored;
    let level = 23 - i32(bit);
    descends = ((mask >> index) & 1u) != 0u;
    if (descends) {
      let side = bitcast<f32>(u32(127 - level) << 23u);
      if (level == voxdag_levels || side <= stop.x + stop.y * exit_t) { break; }
      stack[level - 1] = node;
      node = voxdag_child(node, level - 1, index);
      mask = voxdag_child_mask(node, level);
      continue;
    }
    // Leaves the cell through all planes that it meets there.
    t = exit_t;
    if (t > ray.t_max) { return hit; }
    let crossed = vec3u(planes == vec3f(t));
    let next = corner - (crossed << vec3u(bit));
    let differ = corner ^ next;
    let changed = differ.x | differ.y | differ.z;
    corner = next;
    child ^= crossed.x | (crossed.y << 1u) | (crossed.z << 2u);
    if ((changed >> bit) == 1u) { continue; }  // to a sibling
    // Goes up to the highest level at which the cell has changed.
    bit = firstLeadingBit(changed);
    if (bit > 22u) { return hit; }  // the ray has left the grid
    corner &= vec3u(0xFFFFFFFFu << bit);
    let bits = (corner >> vec3u(bit)) & vec3u(1u);
    child = bits.x | (bits.y << 1u) | (bits.z << 2u);
    node = stack[22u - bit];
    mask = voxdag_child_mask(node, 22 - i32(bit));
  }
  hit.found = true;
  hit.t = t;
  hit.level = 23 - i32(bit);
  for (var axis = 2; axis >= 0; axis--) {
    let is_mirrored = ((ray.mirrored >> u32(axis)) & 1u) != 0u;
    let low = (corner[axis] & 0x7FFFFFu) >> bit;
    hit.cell[axis] = select(low, (1u << u32(hit.level)) - 1u - low, is_mirrored);
    // The ray enters through the first axis whose plane it meets at exactly this T.
    let entry = bitcast<f32>(corner[axis] + (1u << bit));
    if (((ray.parallel >> u32(axis)) & 1u) == 0u && (o[axis] - entry) * inverse[axis] == t) {
      hit.face = 2 * axis + select(1, 0, is_mirrored);
    }
  }
  return hit;
}
