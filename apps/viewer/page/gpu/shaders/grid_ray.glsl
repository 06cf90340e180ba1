// Rays in the grid, and the cells that they hit: the port of trace/grid_ray.hpp and trace/hit.hpp.
//
// Coordinates: the grid is the cube [1,2]^3; axes along which a ray runs up are mirrored, so that
// all rays run down. Distances are in units of the grid's side.

uniform vec3 u_section_low, u_section_high;  // the box that rays see; grid coordinates
uniform vec4 u_section_plane;                // rays see the points p of the box with dot(xyz, p) <= w

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
