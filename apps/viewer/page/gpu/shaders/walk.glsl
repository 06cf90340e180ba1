// Casts a ray at the DAG: the port of trace/cast.hpp and trace/cell_walk.hpp. Comments there explain
// the method and its exactness.

int g_steps = 0;  // steps of all casts of this invocation

// Finds the first cell along the ray that is not empty. Larger cells end the ray where they measure
// at most stop_start + stop_per_t * T; see trace/stop_below_size.hpp.
bool castRay(GridRay ray, float stop_start, float stop_per_t, out CellHit hit) {
  hit = CellHit(0.0, uvec3(0u), 0, 0u);
  if (!(ray.t_min <= ray.t_max) || u_root == kNoNode) return false;
  vec3 o = ray.origin, inv = ray.inverse;
  float t = ray.t_min;
  vec3 leave = (o - vec3(1.0)) * inv;
  if (min(min(leave.x, leave.y), leave.z) <= t) return false;

  uint stack[DAG_MAX_LEVELS];
  uint node = u_root;
  uint mask = childMask(node, 0);
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
#ifdef HAS_HIDDEN
        if (!isLeftOut(cellOf(ray, hit), level))
#endif
        return true;
      } else {
        stack[level - 1] = node;
        node = childOf(node, level - 1, index);
        mask = childMask(node, level);
        --bit;
        up = uvec3(greaterThan((o - uintBitsToFloat(corner | 1u << bit)) * inv, vec3(t)));
        corner |= up << bit;
        child = up.x | up.y << 1u | up.z << 2u;
        continue;
      }
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
