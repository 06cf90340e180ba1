// The DAG in textures, and the cast of a ray at it: the port of trace/cast.hpp, trace/cell_walk.hpp
// and trace/svdag_nodes.hpp. Comments there explain the method and its exactness.
//
// Coordinates: the grid is the cube [1,2]^3; axes along which a ray runs up are mirrored, so that
// all rays run down. Distances are in units of the grid's side.

precision highp float;
precision highp int;
precision highp usampler2D;
precision highp sampler2D;

uniform usampler2D u_nodes;   // r: the words of NODE
uniform usampler2D u_leaves;  // rg: the leaf blocks, lower half first
uniform int u_levels;         // L of the file
uniform int u_shown;          // cells of this level count as voxels; at most L
uniform vec3 u_section_low, u_section_high;  // the part of the grid that rays see; grid coordinates
uniform vec4 u_section_plane;                // and of it the side with dot(xyz, p) <= w

const uint kTexelMask = uint((1 << TEXEL_BITS) - 1);

ivec2 texel(uint i) { return ivec2(int(i & kTexelMask), int(i >> TEXEL_BITS)); }
uint nodeWord(uint i) { return texelFetch(u_nodes, texel(i), 0).x; }
uvec2 leafBlock(uint i) { return texelFetch(u_leaves, texel(i), 0).xy; }

uint bitCount8(uint v) {
  v = v - (v >> 1u & 0x55u);
  v = (v & 0x33u) + (v >> 2u & 0x33u);
  return (v + (v >> 4u)) & 0x0Fu;
}

// Returns a mask whose bit i is set if byte i of the block is not zero.
uint octantsOf(uvec2 block) {
  uvec2 v = block;
  v |= v >> 4u;
  v |= v >> 2u;
  v |= v >> 1u;
  v = ((v & 0x01010101u) * 0x10204080u) >> 28u;
  return v.x | v.y << 4u;
}

uint octantMask(uvec2 block, uint octant) {
  return ((octant & 4u) != 0u ? block.y : block.x) >> (8u * (octant & 3u)) & 0xFFu;
}

// A node is a word index (level < L-2), the index of a leaf block (L-2), or its child mask (L-1).
uint childMask(uint node, int level) {
  if (level < u_levels - DAG_LEAF_LEVELS) return nodeWord(node) & 0xFFu;
  if (level == u_levels - 1) return node;
  return octantsOf(leafBlock(node));
}

uint childOf(uint node, int level, uint index) {
  if (level < u_levels - DAG_LEAF_LEVELS) {
    uint before = nodeWord(node) & ((1u << index) - 1u);
    return nodeWord(node + 1u + bitCount8(before));
  }
  return octantMask(leafBlock(node), index);
}

struct GridRay {
  vec3 origin;    // in [1,2], mirrored
  vec3 inverse;   // 1 / |component|; 2^32 on axes along which the ray does not move
  float t_min, t_max;
  uint mirrored;  // bit per axis
  uint parallel;
  float t_start, t_scale;  // the caller's parameter at T = 0, and its growth
  int cut;        // the ray starts at the section: 0 no; 1, 2, 3 at the box's side across x, y, z; 4 plane
};

GridRay noRay() {
  return GridRay(vec3(1.0), vec3(1.0), 1.0, 0.0, 7u, 0u, 0.0, 1.0, 0);
}

// Limits the ray to the section. `from` is the point at T = 0, `direction` its growth per T.
void clipToSection(vec3 from, vec3 direction, inout GridRay ray) {
  for (int axis = 0; axis < 3; ++axis) {
    float p = from[axis], d = direction[axis];
    float low = u_section_low[axis], high = u_section_high[axis];
    if (low <= 1.0 && high >= 2.0) continue;
    if (abs(d) < 1e-12) {
      if (p < low || p > high) ray.t_max = -1.0;
      continue;
    }
    float a = (low - p) / d, b = (high - p) / d;
    float near = min(a, b), far = max(a, b);
    if (near > ray.t_min) {
      ray.t_min = near;
      ray.cut = axis + 1;
    }
    ray.t_max = min(ray.t_max, far);
  }
  if (u_section_plane.xyz != vec3(0.0)) {
    float along = dot(u_section_plane.xyz, direction);
    float height = u_section_plane.w - dot(u_section_plane.xyz, from);  // >= 0 inside
    if (abs(along) < 1e-12) {
      if (height < 0.0) ray.t_max = -1.0;
    } else if (along > 0.0) {
      ray.t_max = min(ray.t_max, height / along);
    } else if (height / along > ray.t_min) {
      ray.t_min = height / along;
      ray.cut = 4;
    }
  }
}

// Returns the ray from a point of the grid: make_grid_ray(GridPoint, ...).
GridRay rayFromPoint(vec3 start, vec3 direction, float t_min, float t_max) {
  vec3 size = abs(direction);
  float len = max(max(size.x, size.y), size.z);
  GridRay ray = noRay();
  if (!(len > 0.0)) return ray;
  ray.mirrored = 0u;
  for (int axis = 0; axis < 3; ++axis) {
    float d = direction[axis], p = start[axis];
    bool still = !(abs(d) >= 2.3283064e-10 * len);
    bool up = still || d > 0.0;
    float q = still && p > 1.99999988 ? 1.99999988 : p;
    ray.parallel |= still ? 1u << axis : 0u;
    ray.mirrored |= up ? 1u << axis : 0u;
    ray.origin[axis] = up ? 3.0 - q : q;
    ray.inverse[axis] = still ? 4294967296.0 : len / abs(d);
  }
  ray.t_scale = 1.0 / len;
  ray.t_min = t_min * len;
  ray.t_max = t_max * len;
  clipToSection(start, direction / len, ray);
  return ray;
}

// Returns the ray from an eye anywhere; `eye` is relative to the grid's lower corner. Its parameter
// is in units of `direction`.
GridRay rayFromEye(vec3 eye, vec3 direction) {
  GridRay ray = noRay();
  vec3 size = abs(direction);
  float len = max(max(size.x, size.y), size.z);
  if (!(len > 0.0)) return ray;
  vec3 d = direction / len;
  float enter = 0.0, leave = 3e38;
  int enter_axis = -1;
  ray.mirrored = 0u;
  for (int axis = 0; axis < 3; ++axis) {
    bool still = abs(d[axis]) < 2.3283064e-10;
    if (still) {
      ray.parallel |= 1u << axis;
      ray.mirrored |= 1u << axis;
      ray.inverse[axis] = 4294967296.0;
      if (!(eye[axis] >= 0.0 && eye[axis] < 1.0)) return noRay();
      continue;
    }
    float inverse = 1.0 / d[axis];
    float near = ((d[axis] > 0.0 ? 0.0 : 1.0) - eye[axis]) * inverse;
    float far = ((d[axis] > 0.0 ? 1.0 : 0.0) - eye[axis]) * inverse;
    if (near > enter) {
      enter = near;
      enter_axis = axis;
    }
    leave = min(leave, far);
    ray.mirrored |= d[axis] > 0.0 ? 1u << axis : 0u;
    ray.inverse[axis] = abs(inverse);
  }
  if (!(enter <= leave)) return noRay();
  vec3 start;
  for (int axis = 0; axis < 3; ++axis) {
    float p = eye[axis];
    if (axis == enter_axis)
      p = d[axis] > 0.0 ? 0.0 : 1.0;
    else if (enter != 0.0)
      p += enter * d[axis];
    float q = 1.0 + clamp(p, 0.0, 1.0);
    if ((ray.parallel >> axis & 1u) != 0u && q > 1.99999988) q = 1.99999988;
    start[axis] = q;
    ray.origin[axis] = (ray.mirrored >> axis & 1u) != 0u ? 3.0 - q : q;
  }
  ray.t_scale = 1.0 / len;
  ray.t_start = enter * ray.t_scale;
  ray.t_min = 0.0;
  ray.t_max = 3e38;
  clipToSection(start, d, ray);
  return ray;
}

struct CellHit {
  float t;
  uvec3 corner;  // float bits of the cell's lower corner, mirrored
  int level;
  uint node;     // the node that holds the cell: of level min(level - 1, L-2)
};

int g_steps = 0;  // steps of all casts of this invocation

// Ends at cells of at most stop_start + stop_per_t * T; see trace/stop_below_size.hpp.
bool castRay(GridRay ray, float stop_start, float stop_per_t, out CellHit hit) {
  hit = CellHit(0.0, uvec3(0u), 0, 0u);
  if (!(ray.t_min <= ray.t_max)) return false;
  vec3 o = ray.origin, inv = ray.inverse;
  float t = ray.t_min;
  vec3 leave = (o - vec3(1.0)) * inv;
  if (min(min(leave.x, leave.y), leave.z) <= t) return false;

  uint stack[DAG_MOST_LEVELS];
  uint node = 0u;
  uint mask = childMask(0u, 0);
  uvec3 corner = uvec3(0x3F800000u);
  int bit = 22;
  uvec3 up = uvec3(greaterThan((o - uintBitsToFloat(corner | 1u << bit)) * inv, vec3(t)));
  corner |= up << bit;
  uint child = up.x | up.y << 1u | up.z << 2u;
  for (int step = 0; step < MOST_STEPS; ++step) {
    ++g_steps;
    vec3 planes = (o - uintBitsToFloat(corner)) * inv;
    float exit_t = min(min(planes.x, planes.y), planes.z);
    uint index = child ^ ray.mirrored;
    if ((mask >> index & 1u) != 0u) {
      int level = 23 - bit;
      float side = uintBitsToFloat(uint(127 - level) << 23u);
      if (level == u_shown || (level >= 2 && side <= stop_start + stop_per_t * exit_t)) {
        hit.t = t;
        hit.corner = corner;
        hit.level = level;
        hit.node = level == u_levels ? stack[level - 2] : node;
        return true;
      }
      stack[level - 1] = node;
      node = childOf(node, level - 1, index);
      mask = childMask(node, level);
      --bit;
      up = uvec3(greaterThan((o - uintBitsToFloat(corner | 1u << bit)) * inv, vec3(t)));
      corner |= up << bit;
      child = up.x | up.y << 1u | up.z << 2u;
      continue;
    }
    if (exit_t > ray.t_max) return false;
    t = exit_t;
    uvec3 crossed = uvec3(equal(planes, vec3(exit_t)));
    uvec3 next = corner - (crossed << bit);
    uvec3 differ = corner ^ next;
    uint changed = differ.x | differ.y | differ.z;
    corner = next;
    child ^= crossed.x | crossed.y << 1u | crossed.z << 2u;
    if (changed >> bit == 1u) continue;
    if (changed >= 0x800000u) return false;
    bit = int(floatBitsToUint(float(changed)) >> 23u) - 127;
    corner &= uvec3(~0u << bit);
    uvec3 bits = corner >> bit & 1u;
    child = bits.x | bits.y << 1u | bits.z << 2u;
    node = stack[22 - bit];
    mask = childMask(node, 22 - bit);
  }
  return false;
}

// Returns the side through which the ray entered the cell, as Face in trace/hit.hpp: 2 * axis, plus
// 1 for the upper side; -1 if the ray starts inside.
int enteredFace(GridRay ray, CellHit hit) {
  for (int axis = 0; axis < 3; ++axis) {
    float entry = uintBitsToFloat(hit.corner[axis] + (1u << (23 - hit.level)));
    if ((ray.parallel >> axis & 1u) == 0u && (ray.origin[axis] - entry) * ray.inverse[axis] == hit.t)
      return 2 * axis + ((ray.mirrored >> axis & 1u) != 0u ? 0 : 1);
  }
  return -1;
}

vec3 faceNormal(int face) {
  vec3 normal = vec3(0.0);
  if (face >= 0) normal[face >> 1] = (face & 1) != 0 ? 1.0 : -1.0;
  return normal;
}

// Returns the cell's coordinates among the cells of its level.
ivec3 cellOf(GridRay ray, CellHit hit) {
  ivec3 cell;
  for (int axis = 0; axis < 3; ++axis) {
    int low = int((hit.corner[axis] & 0x7FFFFFu) >> (23 - hit.level));
    cell[axis] = (ray.mirrored >> axis & 1u) != 0u ? (1 << hit.level) - 1 - low : low;
  }
  return cell;
}
