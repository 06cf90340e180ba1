// A plain walk of the octree, the rival of walk.glsl: from each empty cell it begins again at the
// root. It hits the cells that walk.glsl hits.

int g_steps = 0;  // steps of all casts of this invocation

bool castRay(GridRay ray, float stop_start, float stop_per_t, out CellHit hit) {
  hit = CellHit(0.0, uvec3(0u), 0, 0u);
  if (!(ray.t_min <= ray.t_max)) return false;
  vec3 o = ray.origin, inv = ray.inverse;
  float t = ray.t_min;
  vec3 leave = (o - vec3(1.0)) * inv;
  float root_exit = min(min(leave.x, leave.y), leave.z);
  for (int cells = 0; cells < MOST_STEPS; ++cells) {
    if (root_exit <= t) return false;
    uint node = u_root, above = 0u;
    uvec3 corner = uvec3(0x3F800000u);
    float exit_t = t;
    for (int level = 1; level <= DAG_MOST_LEVELS; ++level) {
      ++g_steps;
      uint mask = childMask(node, level - 1);
      int bit = 23 - level;
      uvec3 up = uvec3(greaterThan((o - uintBitsToFloat(corner | 1u << bit)) * inv, vec3(t)));
      corner |= up << bit;
      uint index = (up.x | up.y << 1u | up.z << 2u) ^ ray.mirrored;
      vec3 planes = (o - uintBitsToFloat(corner)) * inv;
      exit_t = min(min(planes.x, planes.y), planes.z);
      if ((mask >> index & 1u) == 0u) break;
      float side = uintBitsToFloat(uint(127 - level) << 23u);
      if (level == u_shown || (level >= 2 && side <= stop_start + stop_per_t * exit_t)) {
        hit = CellHit(t, corner, level, level == u_levels ? above : node);
        return true;
      }
      above = node;
      node = childOf(node, level - 1, index);
    }
    if (exit_t > ray.t_max) return false;
    t = exit_t;
  }
  return false;
}
