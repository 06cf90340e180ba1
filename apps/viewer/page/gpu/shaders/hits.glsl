// The cell that each pixel's ray hits, as numbers: for tests that compare them with the CPU's.

// xyz: the cell among those of its level; w: level, (face + 1) << 8, hit << 16, steps << 17
layout(location = 0) out uvec4 out_hit;

void main() {
  GridRay ray = rayFromEye(u_eye, pixelDirection(pixelOfFragment()));
  float scale = u_lod * u_pixel_size;
  CellHit hit;
  bool is_hit = castRay(ray, scale * ray.t_start, scale * ray.t_scale, hit);
  out_hit = uvec4(0u, 0u, 0u, uint(g_steps) << 17u);
  if (!is_hit) return;
  out_hit.xyz = uvec3(cellOf(ray, hit));
  out_hit.w |= uint(hit.level | (enteredFace(ray, hit) + 1) << 8 | 1 << 16);
}
