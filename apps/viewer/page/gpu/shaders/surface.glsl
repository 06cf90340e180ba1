// The smooth surface from the cells around a cell: the port of render/surface_normal.hpp and
// trace/cell_blocks.hpp, whose comments explain the method.

uniform int u_coarser_fits;  // coarser levels that smooth the normal

float smoothStep(float low, float high, float x) {
  float t = clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Moves `node` from from_level down to the node of to_level at `cell`, in cells of to_level.
bool descend(inout uint node, int from_level, int to_level, ivec3 cell) {
  for (int level = from_level; level < to_level; ++level) {
    ivec3 b = cell >> (to_level - 1 - level) & 1;
    uint index = uint(b.x | b.y << 1 | b.z << 2);
    if ((childMask(node, level) >> index & 1u) == 0u) return false;
    node = childOf(node, level, index);
  }
  return true;
}

// Returns the mask of the 4^3 cells two levels below the node.
uvec2 cellMask(uint node, int level) {
  if (level == u_levels - DAG_LEAF_LEVELS) return leafBlock(node);
  uint mask = childMask(node, level);
  uvec2 cells = uvec2(0u);
  for (uint i = 0u; i < 8u; ++i) {
    if ((mask >> i & 1u) == 0u) continue;
    uint children = childMask(childOf(node, level, i), level + 1);
    if (i < 4u)
      cells.x |= children << (8u * i);
    else
      cells.y |= children << (8u * (i - 4u));
  }
  return cells;
}

struct LayerFit {
  vec3 normal, mean;
  float thickness;
};

struct SmoothSurface {
  vec3 normal;
  float height, is_flat;
};

// Sums of the fit over 32 cells of a block, from its lower (half = 0) or upper half.
void addCells(uint cells, int half_of_block, vec3 base, inout float weight, inout vec3 mean, inout vec3 squares,
              inout vec3 products) {
  while (cells != 0u) {
    uint lowest = cells & (~cells + 1u);
    cells ^= lowest;
    int i = int(floatBitsToUint(float(lowest)) >> 23u) - 127 + 32 * half_of_block;
    vec3 d = base + vec3(float((i & 1) | (i >> 2 & 2)), float((i >> 1 & 1) | (i >> 3 & 2)),
                         float((i >> 2 & 1) | (i >> 4 & 2)));
    float fall = 1.0 - dot(d, d) * (1.0 / (NORMAL_RADIUS * NORMAL_RADIUS));
    if (fall <= 0.0) continue;
    float w = fall * fall;
    weight += w;
    mean += d * w;
    squares += d * d * w;
    products += vec3(d.x * d.y, d.x * d.z, d.y * d.z) * w;
  }
}

LayerFit fitLayer(int level, ivec3 cell, vec3 offset, vec3 front) {
  ivec3 low_half = ivec3(lessThan(cell & 3, ivec3(2)));
  ivec3 block = (cell >> 2) - low_half;
  int block_level = level - 2;
  int last = (1 << block_level) - 1;
  ivec3 lo = max(block, ivec3(0)), hi = min(block + 1, ivec3(last));
  float weight = 0.0;
  vec3 mean = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);
  if (all(lessThanEqual(lo, hi))) {
    ivec3 differ = lo ^ hi;
    int apart = differ.x | differ.y | differ.z;
    int up = apart == 0 ? 0 : int(floatBitsToUint(float(apart)) >> 23u) - 126;
    int common_level = block_level - up;
    uint common_node = u_root;
    if (descend(common_node, 0, common_level, lo >> up)) {
      for (int corner = 0; corner < 8; ++corner) {
        ivec3 at = block + (ivec3(corner, corner >> 1, corner >> 2) & 1);
        if (any(lessThan(at, lo)) || any(greaterThan(at, hi))) continue;
        uint node = common_node;
        if (!descend(node, common_level, block_level, at)) continue;
        uvec2 cells = cellMask(node, block_level);
        vec3 base = vec3(at * 4 - cell) - offset;
        addCells(cells.x, 0, base, weight, mean, squares, products);
        addCells(cells.y, 1, base, weight, mean, squares, products);
      }
    }
  }
  if (!(weight > 0.0)) return LayerFit(front, vec3(0.0), 0.0);
  mean /= weight;
  vec3 s = vec3(1.0 / 12.0) + squares / weight - mean * mean;                                    // xx yy zz
  vec3 p = products / weight - vec3(mean.x * mean.y, mean.x * mean.z, mean.y * mean.z);          // xy xz yz
  mat3 covariance = mat3(s.x, p.x, p.y, p.x, s.y, p.z, p.y, p.z, s.z);
  vec3 a = vec3(s.y * s.z - p.z * p.z, s.x * s.z - p.y * p.y, s.x * s.y - p.x * p.x);
  vec3 b = vec3(p.y * p.z - p.x * s.z, p.x * p.z - p.y * s.y, p.x * p.y - s.x * p.z);
  mat3 adjugate = mat3(a.x, b.x, b.y, b.x, a.y, b.z, b.y, b.z, a.z);
  vec3 normal = front;
  for (int i = 0; i < NORMAL_POWER; ++i) normal = normalize(adjugate * normal);
  return LayerFit(normal, mean, dot(normal, covariance * normal));
}

SmoothSurface smoothSurface(int level, ivec3 cell, vec3 view, vec3 face) {
  LayerFit fine = fitLayer(level, cell, vec3(0.0), normalize(view + face));
  vec3 normal = fine.normal;
  float edge = smoothStep(NORMAL_PLANE, NORMAL_EDGE, fine.thickness);
  if ((dot(normal, view) < 0.0) != (dot(normal, face) < 0.0) && dot(normal, fine.mean) > 0.0) normal = -normal;
  float outline = edge * smoothStep(NORMAL_OUTLINE_COSINE, 0.0, dot(normal, view));
  normal = normalize(mix(normal, face, outline));
  for (int up = 1; up <= u_coarser_fits && level - up >= 2; ++up) {
    ivec3 at = cell >> up;
    vec3 offset = (vec3(cell - (at << up)) + 0.5) / float(1 << up) - 0.5;
    LayerFit fit = fitLayer(level - up, at, offset, normal);
    float trust = smoothStep(NORMAL_THICK, NORMAL_THIN, fit.thickness);
    if (trust <= 0.0) break;
    normal = normalize(mix(normal, fit.normal, trust));
  }
  return SmoothSurface(normal, dot(normal, fine.mean), 1.0 - edge);
}

float cubeHeight(vec3 normal) {
  return abs(normal.x) + abs(normal.y) + abs(normal.z);
}

vec3 gridPoint(vec3 place) { return 1.0 + clamp(place, 0.0, 1.0); }
