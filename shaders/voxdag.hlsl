// Rays through a sparse voxel DAG, for Direct3D and Vulkan: voxdag.glsl, which explains the method, in HLSL.
//
// Before this file, declare what it reads: the words of the chunks NODE and LEAF of a plain .vdag file, as they are, and the levels of
// the grid, which has 2^voxdag_levels voxels a side; 0 if it has no voxels.
//
//   StructuredBuffer<uint> voxdag_nodes : register(t0);
//   StructuredBuffer<uint2> voxdag_leaves : register(t1);
//   cbuffer Scene : register(b0) { int voxdag_levels; };

static const int VOXDAG_MAX_LEVELS = 20;
static const int VOXDAG_LEAF_LEVELS = 2;  // a leaf block has 4^3 voxels
static const int VOXDAG_NO_FACE = -1;

// 48 bytes. voxdag_enter_grid() of voxdag.h makes exact ones on the CPU.
struct VoxdagRay {
  float3 origin;   // in [1,2], mirrored
  float t_min;     // the range of T
  float3 inverse;  // 1 / |component|; 2^32 on axes along which the ray does not move
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
  uint3 cell;  // its coordinates among the 2^level cells of each axis
};

// The eight children of a node: bit i is child i, x + 2 y + 4 z.
// A node is a word index (levels below L-2), the index of a leaf block (L-2), or its own mask (L-1).
uint voxdagChildMask(uint node, int level) {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS) return voxdag_nodes[node] & 0xFFu;
  if (level == voxdag_levels - 1) return node;
  uint2 block = voxdag_leaves[node];  // byte i is the mask of octant i
  block |= block >> 4;
  block |= block >> 2;
  block |= block >> 1;
  block = ((block & 0x01010101u) * 0x10204080u) >> 28;
  return block.x | block.y << 4;
}

uint voxdagChild(uint node, int level, uint index) {
  if (level < voxdag_levels - VOXDAG_LEAF_LEVELS)
    return voxdag_nodes[node + 1 + countbits(voxdag_nodes[node] & ((1u << index) - 1))];
  uint2 block = voxdag_leaves[node];
  return ((index & 4) != 0 ? block.y : block.x) >> (8 * (index & 3)) & 0xFFu;
}

// Returns whether the cell of a level, 0 to voxdag_levels, has voxels. Coordinates outside of the grid have none.
bool voxdagContains(int3 cell, int level) {
  if (voxdag_levels == 0 || any((cell >> level) != int3(0, 0, 0))) return false;
  uint node = 0;
  for (int l = 0; l < level; ++l) {
    uint3 bits = uint3(cell >> (level - 1 - l)) & 1u;
    uint index = bits.x | bits.y << 1 | bits.z << 2;
    if ((voxdagChildMask(node, l) >> index & 1u) == 0) return false;
    if (l + 1 < voxdag_levels) node = voxdagChild(node, l, index);
  }
  return true;
}

// Returns the ray of the points origin + t * direction, 0 <= t <= t_max. `origin` is relative to the grid's lower corner, in sides of
// the grid: (world - info.origin) / (info.voxel_size * info.resolution). It may lie anywhere. The direction, in any unit, need not have
// unit length. A ray that misses the grid has t_max < t_min.
VoxdagRay voxdagRay(float3 origin, float3 direction, float t_max) {
  VoxdagRay ray;
  ray.origin = ray.inverse = float3(1, 1, 1);
  ray.t_min = 1;
  ray.t_max = 0;
  ray.mirrored = 7;
  ray.parallel = 0;
  ray.t_start = 0;
  ray.t_scale = 1;
  float3 size = abs(direction);
  float longest = max(max(size.x, size.y), size.z);
  if (!(longest > 0)) return ray;
  float3 d = direction / longest;
  float enter = 0, leave = 3e38;
  int enter_axis = -1;
  uint mirrored = 0, parallel = 0;
  float3 inverse = float3(4294967296.0, 4294967296.0, 4294967296.0);
  int axis;
  for (axis = 0; axis < 3; ++axis) {
    if (abs(d[axis]) < 2.3283064e-10) {
      if (!(origin[axis] >= 0 && origin[axis] < 1)) return ray;
      parallel |= 1u << axis;
      mirrored |= 1u << axis;
      continue;
    }
    float i = 1 / d[axis];
    float near_t = ((d[axis] > 0 ? 0.0 : 1.0) - origin[axis]) * i;
    float far_t = ((d[axis] > 0 ? 1.0 : 0.0) - origin[axis]) * i;
    if (near_t > enter) {
      enter = near_t;
      enter_axis = axis;
    }
    leave = min(leave, far_t);
    mirrored |= d[axis] > 0 ? 1u << axis : 0u;
    inverse[axis] = abs(i);
  }
  if (!(enter <= leave)) return ray;
  for (axis = 0; axis < 3; ++axis) {
    float p = origin[axis];
    if (axis == enter_axis)
      p = d[axis] > 0 ? 0.0 : 1.0;
    else if (enter != 0)
      p += enter * d[axis];
    float q = 1 + clamp(p, 0.0, 1.0);
    if ((parallel >> axis & 1u) != 0) q = min(q, 1.99999988);
    ray.origin[axis] = (mirrored >> axis & 1u) != 0 ? 3 - q : q;
  }
  ray.inverse = inverse;
  ray.mirrored = mirrored;
  ray.parallel = parallel;
  ray.t_scale = 1 / longest;
  ray.t_start = enter * ray.t_scale;
  ray.t_min = 0;
  ray.t_max = t_max * longest - enter;
  return ray;
}

// Finds the first voxel along a ray. With `stop`, the ray ends earlier, at the first cell with voxels whose side is at most
// stop.x + stop.y * T, in sides of the grid: for beams and level of detail. float2(0, 0) finds voxels.
bool voxdagCast(VoxdagRay ray, float2 stop, out VoxdagHit hit) {
  hit.t = 0;
  hit.face = VOXDAG_NO_FACE;
  hit.level = 0;
  hit.cell = uint3(0, 0, 0);
  float3 o = ray.origin, inverse = ray.inverse;
  float3 leave = (o - 1) * inverse;
  float t = ray.t_min;
  if (voxdag_levels == 0 || !(t <= ray.t_max) || min(min(leave.x, leave.y), leave.z) <= t) return false;

  // The path to the parent of the current cell, and the cell that the ray is in at T: of level 23 - bit, with its lower corner as
  // float bits. Neighbours of its size differ in this bit of the corner.
  uint stack[VOXDAG_MAX_LEVELS];
  uint node = 0, mask = voxdagChildMask(0, 0);
  uint3 corner = uint3(0x3F800000u, 0x3F800000u, 0x3F800000u);
  uint child = 0;
  int bit = 23;
  bool descends = true;
  for (;;) {
    if (descends) {  // to the child that the ray is in at T
      --bit;
      uint3 up = uint3((o - asfloat(corner | 1u << bit)) * inverse > float3(t, t, t));
      corner |= up << bit;
      child = up.x | up.y << 1 | up.z << 2;
    }
    float3 planes = (o - asfloat(corner)) * inverse;
    float exit_t = min(min(planes.x, planes.y), planes.z);
    uint index = child ^ ray.mirrored;
    int level = 23 - bit;
    descends = (mask >> index & 1u) != 0;
    if (descends) {
      float side = asfloat(uint(127 - level) << 23);
      if (level == voxdag_levels || side <= stop.x + stop.y * exit_t) break;
      stack[level - 1] = node;
      node = voxdagChild(node, level - 1, index);
      mask = voxdagChildMask(node, level);
      continue;
    }
    // Leaves the cell through all planes that it meets there.
    t = exit_t;
    if (t > ray.t_max) return false;
    uint3 crossed = uint3(planes == float3(t, t, t));
    uint3 next = corner - (crossed << bit), differ = corner ^ next;
    uint changed = differ.x | differ.y | differ.z;
    corner = next;
    child ^= crossed.x | crossed.y << 1 | crossed.z << 2;
    if (changed >> bit == 1) continue;  // to a sibling
    // Goes up to the highest level at which the cell has changed.
    bit = int(firstbithigh(changed));
    if (bit > 22) return false;  // the ray has left the grid
    corner &= 0xFFFFFFFFu << bit;
    uint3 bits = corner >> bit & 1u;
    child = bits.x | bits.y << 1 | bits.z << 2;
    node = stack[22 - bit];
    mask = voxdagChildMask(node, 22 - bit);
  }
  hit.t = t;
  hit.level = 23 - bit;
  for (int axis = 2; axis >= 0; --axis) {
    bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
    uint low = (corner[axis] & 0x7FFFFFu) >> bit;
    hit.cell[axis] = is_mirrored ? (1u << hit.level) - 1 - low : low;
    // The ray enters through the first axis whose plane it meets at exactly this T.
    float entry = asfloat(corner[axis] + (1u << bit));
    if ((ray.parallel >> axis & 1u) == 0 && (o[axis] - entry) * inverse[axis] == t) hit.face = 2 * axis + (is_mirrored ? 0 : 1);
  }
  return true;
}
