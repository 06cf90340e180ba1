// The cell that each pixel's ray hits, as numbers: for tests that compare them with the CPU's.
layout(location = 0) out uvec4 out_hit;  // xyz: the cell among those of its level; w: level, (face + 1) << 8, hit << 16

void main() {
  GridRay ray = rayFromEye(u_eye, pixelDirection(pixelOfFragment()));
  float scale = u_lod * u_pixel_size;
  CellHit hit;
  out_hit = uvec4(0u);
  if (!castRay(ray, scale * ray.t_start, scale * ray.t_scale, hit)) return;
  out_hit = uvec4(uvec3(cellOf(ray, hit)), uint(hit.level | (enteredFace(ray, hit) + 1) << 8 | 1 << 16));
}
