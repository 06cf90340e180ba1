// The view sample of each pixel: what its primary ray hits, ready to be lit.

uniform vec3 u_ground_middle, u_ground_up;  // relative to the grid's corner, in its sides
uniform float u_ground_radius;              // 0: no ground
uniform int u_show;            // SHOW_*
uniform usampler2D u_node_instances, u_leaf_instances;

layout(location = 0) out vec4 out_start;   // where rays start, grid coordinates; w: the cell's side, 0 without a hit
layout(location = 1) out vec4 out_normal;  // shading normal; w: depth in grid sides
layout(location = 2) out vec4 out_face;    // xy: octahedral normal of the face; z: colour code; w: the value to show

void main() {
  vec3 direction = pixelDirection(pixelOfFragment());
  GridRay ray = rayFromEye(u_eye, direction);
  float scale = u_lod * u_pixel_size;
  CellHit hit;
  bool is_hit = castRay(ray, scale * ray.t_start, scale * ray.t_scale, hit);
  float steps = float(g_steps);
  out_start = vec4(0.0);
  out_normal = vec4(0.0, 0.0, 0.0, -1.0);
  out_face = vec4(0.0, 0.0, -1.0, steps);
  if (!is_hit) {
    // The ground of render/ground.hpp.
    float height = dot(u_eye - u_ground_middle, u_ground_up), fall = -dot(direction, u_ground_up);
    if (u_show != SHOW_LIGHT || u_ground_radius <= 0.0 || height <= 0.0 || fall <= 0.0) return;
    vec3 on_ground = u_eye + direction * (height / fall);
    vec3 aside = on_ground - u_ground_middle;
    float left = 1.0 - dot(aside, aside) / (u_ground_radius * u_ground_radius);
    if (left <= 0.0) return;
    float side = 1.0 / float(1 << u_levels);
    for (int level = u_levels; level > 2 && side * 2.0 <= scale * height / fall; --level) side *= 2.0;
    out_start = vec4(1.0 + on_ground + u_ground_up * (0.25 * side), side);
    out_normal = vec4(u_ground_up, -1.0);
    out_face = vec4(packUnit(u_ground_up), -3.0, left * left);
    return;
  }

  float depth = ray.t_start + hit.t * ray.t_scale;
  ViewSample seen = viewSample(ray, hit, u_eye, direction, depth, depth);
  vec3 start = u_show == SHOW_LIGHT || u_show == SHOW_OCCLUSION ? startPoint(seen, u_eye, direction, depth) : gridPoint(seen.place);
  float value = steps;
  if (u_show == SHOW_LEVEL) value = float(hit.level);
  if (u_show == SHOW_SHARING) {
    uint code = hit.level >= u_levels - 1 ? texelFetch(u_leaf_instances, texel(hit.node), 0).x
                                          : texelFetch(u_node_instances, texel(hit.node), 0).x;
    value = float(code) / float(INSTANCE_STEPS);
  }
  out_start = vec4(start, seen.cell_side);
  out_normal = vec4(seen.normal, depth);
  out_face = vec4(packUnit(seen.face), seen.color, value);
}
