// Rays through a sparse voxel DAG, for OpenGL 4.3, OpenGL ES 3.1 and Vulkan. voxdag.wgsl and voxdag.hlsl are the same in other
// languages; docs/shaders.md explains all three.
//
// Before this file, declare what it reads: the words of the chunks NODE and LEAF of a plain .vdag file, as they are (voxdag.h calls
// them scene.nodes and scene.leaves), and the levels of the grid, which has 2^voxdag_levels voxels a side; 0 if it has no voxels.
//
//   layout(std430, binding = 0) readonly buffer Nodes { uint voxdag_nodes[]; };
//   layout(std430, binding = 1) readonly buffer Leaves { uvec2 voxdag_leaves[]; };
//   uniform int voxdag_levels;
//
// Source of the walk: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4. The grid is the cube [1,2]^3, so that
// the bits of a coordinate's mantissa are the child indices of the cells around it. Axes along which a ray runs up are mirrored
// (p -> 3 - p): all rays run down. A ray's parameter T is 0 at its origin, and grows by 1 while the ray crosses the grid along its
// longest axis. It meets the plane p of an axis at (origin - p) * inverse: the difference is exact and the product is rounded once, so
// every device that rounds as IEEE 754 does finds the same T, and the same voxel.

const int VOXDAG_MAX_LEVELS = 20;
const int VOXDAG_LEAF_LEVELS = 2;  // a leaf block has 4^3 voxels
const int VOXDAG_NO_FACE = -1;

// In std430 layout 48 bytes. voxdag_enter_grid() of voxdag.h makes exact ones on the CPU.
struct VoxdagRay {
  vec3 origin;     // in [1,2], mirrored
  float t_min;     // the range of T
  vec3 inverse;    // 1 / |component|; 2^32 on axes along which the ray does not move
  float t_max;
  uint mirrored;   // a bit per axis
  uint parallel;   // axes along which the ray does not move
  float t_start;   // the caller's parameter is t_start + t_scale * T
  float t_scale;
};

struct VoxdagHit {
  float t;     // T where the ray enters the cell; t_min if it starts inside
  int face;    // -x, +x, -y, +y, -z, +z are 0 to 5; VOXDAG_NO_FACE if the ray starts inside
  int level;   // of the cell: voxdag_levels if it is a voxel
  uvec3 cell;  // its coordinates among the 2^level cells of each axis
};

// The eight children of a node: bit i is child i, x + 2 y + 4 z.
// A node is a word index (levels below L-2), the index of a leaf block (L-2), or its own mask (L-1).
uint voxdagChildMask(uint node, int level) {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS) return voxdag_nodes[node] & 0xFFu;
  if (level == voxdag_levels - 1) return node;
  uvec2 block = voxdag_leaves[node];  // byte i is the mask of octant i
  block |= block >> 4u;
  block |= block >> 2u;
  block |= block >> 1u;
  block = ((block & 0x01010101u) * 0x10204080u) >> 28u;
  return block.x | block.y << 4u;
}

uint voxdagChild(uint node, int level, uint index) {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS)
    return voxdag_nodes[node + 1u + uint(bitCount(voxdag_nodes[node] & ((1u << index) - 1u)))];
  uvec2 block = voxdag_leaves[node];
  return ((index & 4u) != 0u ? block.y : block.x) >> (8u * (index & 3u)) & 0xFFu;
}

// Returns whether the cell of a level, 0 to voxdag_levels, has voxels. Coordinates outside of the grid have none.
bool voxdagContains(ivec3 cell, int level) {
  if (voxdag_levels == 0 || any(notEqual(cell >> level, ivec3(0)))) return false;
  uint node = 0u;
  for (int l = 0; l < level; ++l) {
    uvec3 bits = uvec3(cell >> (level - 1 - l)) & 1u;
    uint index = bits.x | bits.y << 1u | bits.z << 2u;
    if ((voxdagChildMask(node, l) >> index & 1u) == 0u) return false;
    if (l + 1 < voxdag_levels) node = voxdagChild(node, l, index);
  }
  return true;
}

// Returns the ray of the points origin + t * direction, 0 <= t <= t_max. `origin` is relative to the grid's lower corner, in sides of
// the grid: (world - info.origin) / (info.voxel_size * info.resolution). It may lie anywhere. The direction, in any unit, need not have
// unit length. A ray that misses the grid has t_max < t_min.
VoxdagRay voxdagRay(vec3 origin, vec3 direction, float t_max) {
  VoxdagRay ray = VoxdagRay(vec3(1.0), 1.0, vec3(1.0), 0.0, 7u, 0u, 0.0, 1.0);
  vec3 size = abs(direction);
  float longest = max(max(size.x, size.y), size.z);
  if (!(longest > 0.0)) return ray;
  vec3 d = direction / longest;
  float enter = 0.0, leave = 3e38;
  int enter_axis = -1;
  uint mirrored = 0u, parallel = 0u;
  vec3 inv = vec3(4294967296.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (abs(d[axis]) < 2.3283064e-10) {
      if (!(origin[axis] >= 0.0 && origin[axis] < 1.0)) return ray;
      parallel |= 1u << axis;
      mirrored |= 1u << axis;
      continue;
    }
    float i = 1.0 / d[axis];
    float near_t = ((d[axis] > 0.0 ? 0.0 : 1.0) - origin[axis]) * i;
    float far_t = ((d[axis] > 0.0 ? 1.0 : 0.0) - origin[axis]) * i;
    if (near_t > enter) {
      enter = near_t;
      enter_axis = axis;
    }
    leave = min(leave, far_t);
    mirrored |= d[axis] > 0.0 ? 1u << axis : 0u;
    inv[axis] = abs(i);
  }
  if (!(enter <= leave)) return ray;
  for (int axis = 0; axis < 3; ++axis) {
    float p = origin[axis];
    if (axis == enter_axis)
      p = d[axis] > 0.0 ? 0.0 : 1.0;
    else if (enter != 0.0)
      p += enter * d[axis];
    float q = 1.0 + clamp(p, 0.0, 1.0);
    if ((parallel >> axis & 1u) != 0u) q = min(q, 1.99999988);
    ray.origin[axis] = (mirrored >> axis & 1u) != 0u ? 3.0 - q : q;
  }
  ray.inverse = inv;
  ray.mirrored = mirrored;
  ray.parallel = parallel;
  ray.t_scale = 1.0 / longest;
  ray.t_start = enter * ray.t_scale;
  ray.t_min = 0.0;
  ray.t_max = t_max * longest - enter;
  return ray;
}

// Finds the first voxel along a ray. With `stop`, the ray ends earlier, at the first cell with voxels whose side is at most
// stop.x + stop.y * T, in sides of the grid: for beams and level of detail. vec2(0) finds voxels.
bool voxdagCast(VoxdagRay ray, vec2 stop, out VoxdagHit hit) {
  hit = VoxdagHit(0.0, VOXDAG_NO_FACE, 0, uvec3(0u));
  vec3 o = ray.origin, inv = ray.inverse;
  vec3 leave = (o - 1.0) * inv;
  float t = ray.t_min;
  if (voxdag_levels == 0 || !(t <= ray.t_max) || min(min(leave.x, leave.y), leave.z) <= t) return false;

  // The path to the parent of the current cell, and the cell that the ray is in at T: of level 23 - bit, with its lower corner as
  // float bits. Neighbours of its size differ in this bit of the corner.
  uint stack[VOXDAG_MAX_LEVELS];
  uint node = 0u, mask = voxdagChildMask(0u, 0);
  uvec3 corner = uvec3(0x3F800000u);
  uint child = 0u;
  int bit = 23;
  bool descends = true;
  for (;;) {
    if (descends) {  // to the child that the ray is in at T
      --bit;
      uvec3 up = uvec3(greaterThan((o - uintBitsToFloat(corner | 1u << bit)) * inv, vec3(t)));
      corner |= up << bit;
      child = up.x | up.y << 1u | up.z << 2u;
    }
    vec3 planes = (o - uintBitsToFloat(corner)) * inv;
    float exit_t = min(min(planes.x, planes.y), planes.z);
    uint index = child ^ ray.mirrored;
    int level = 23 - bit;
    descends = (mask >> index & 1u) != 0u;
    if (descends) {
      float side = uintBitsToFloat(uint(127 - level) << 23u);
      if (level == voxdag_levels || side <= stop.x + stop.y * exit_t) break;
      stack[level - 1] = node;
      node = voxdagChild(node, level - 1, index);
      mask = voxdagChildMask(node, level);
      continue;
    }
    // Leaves the cell through all planes that it meets there.
    t = exit_t;
    if (t > ray.t_max) return false;
    uvec3 crossed = uvec3(equal(planes, vec3(t)));
    uvec3 next = corner - (crossed << bit), differ = corner ^ next;
    uint changed = differ.x | differ.y | differ.z;
    corner = next;
    child ^= crossed.x | crossed.y << 1u | crossed.z << 2u;
    if (changed >> bit == 1u) continue;  // to a sibling
    // Goes up to the highest level at which the cell has changed.
    bit = findMSB(changed);
    if (bit > 22) return false;  // the ray has left the grid
    corner &= uvec3(0xFFFFFFFFu << bit);
    uvec3 bits = corner >> bit & 1u;
    child = bits.x | bits.y << 1u | bits.z << 2u;
    node = stack[22 - bit];
    mask = voxdagChildMask(node, 22 - bit);
  }
  hit.t = t;
  hit.level = 23 - bit;
  for (int axis = 2; axis >= 0; --axis) {
    bool is_mirrored = (ray.mirrored >> axis & 1u) != 0u;
    uint low = (corner[axis] & 0x7FFFFFu) >> bit;
    hit.cell[axis] = is_mirrored ? (1u << hit.level) - 1u - low : low;
    // The ray enters through the first axis whose plane it meets at exactly this T.
    float entry = uintBitsToFloat(corner[axis] + (1u << bit));
    if ((ray.parallel >> axis & 1u) == 0u && (o[axis] - entry) * inv[axis] == t) hit.face = 2 * axis + (is_mirrored ? 0 : 1);
  }
  return true;
}
