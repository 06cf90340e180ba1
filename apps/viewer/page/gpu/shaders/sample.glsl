// The view sample of each pixel: what its primary ray hits, ready to be lit. The port of
// render/voxel_view_samples.hpp.

uniform float u_cube_pixels;
uniform vec3 u_ground_middle, u_ground_up;  // relative to the grid's corner, in its sides
uniform float u_ground_radius;              // 0: no ground
uniform float u_hatch_period;               // of the lines on cut faces, in grid sides; 0: none
uniform int u_show;            // SHOW_*
uniform usampler2D u_node_instances, u_leaf_instances;
uniform int u_color_bits, u_normal_bits;  // precision of the stored values; -1: none
uniform usampler2D u_color_words, u_color_pages, u_normal_words, u_normal_pages;
uniform uint u_color_overlay, u_normal_overlay;

layout(location = 0) out vec4 out_start;   // where rays start, grid coordinates; w: the cell's side, 0 without a hit
layout(location = 1) out vec4 out_normal;  // shading normal; w: depth in grid sides
layout(location = 2) out vec4 out_face;    // xy: octahedral normal of the face; z: colour code; w: the value to show

// is_hatched() of render/hatch.hpp.
bool isHatched(vec3 place, vec3 normal) {
  if (u_hatch_period <= 0.0) return false;
  vec3 size = abs(normal);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return fract((place.x + place.y + place.z - place[axis]) / u_hatch_period) < LIGHT_HATCH_WIDTH;
}

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
  float cell_side = uintBitsToFloat(uint(127 - hit.level) << 23u);
  vec3 view = -normalize(direction);
  vec3 place = u_eye + direction * depth;
  bool is_cut = ray.cut != 0 && hit.t == ray.t_min;
  vec3 normal, face;
  float color = -1.0;
  if (is_cut) {
    normal = ray.cut == 4 ? u_section_plane.xyz : vec3(0.0);
    if (ray.cut < 4) normal[ray.cut - 1] = direction[ray.cut - 1] > 0.0 ? -1.0 : 1.0;
    face = normal;
    color = isHatched(place, normal) ? -2.25 : -2.0;
  } else {
    int side = enteredFace(ray, hit);
    vec3 entered = side < 0 ? view : faceNormal(side);
    ivec3 cell = cellOf(ray, hit);
    float cell_pixels = cell_side / (u_pixel_size * depth);
    float cube = smoothStep(u_cube_pixels * 0.5, u_cube_pixels, cell_pixels);
    normal = entered;
    SmoothSurface smooth_one = SmoothSurface(entered, 0.0, 0.0);
    if (cube < 1.0 && hit.level >= 2) {
      smooth_one = smoothSurface(hit.level, cell, view, entered);
      normal = normalize(mix(smooth_one.normal, entered, cube));
    }
    face = normal;
#ifdef HAS_LOOK
    if (u_finest >= 0) {
      uint number;
      uvec3 value;
      bool is_stored = findNumber(cell, hit.level, number);
      if (u_color_bits >= 0 &&
          readLook(u_color_overlay, cell, hit.level, is_stored, number, u_color_words, u_color_pages, uint(u_color_bits), value))
        color = float(value.x | value.y << 8u | value.z << 16u);
      if (u_normal_bits >= 0 &&
          readLook(u_normal_overlay, cell, hit.level, is_stored, number, u_normal_words, u_normal_pages, uint(u_normal_bits), value)) {
        vec3 stored = vec3(ivec3(value) - 128);
        stored = stored == vec3(0.0) ? vec3(0.0, 1.0, 0.0) : normalize(stored);
        float facing = dot(stored, view);
        bool of_back = facing < -NORMAL_LEANING || (facing < 0.0 && dot(stored, entered) < -NORMAL_OPPOSITE);
        normal = of_back ? -stored : stored;
      }
    }
#endif
    // voxel_view_sample() of render/voxel_view_samples.hpp.
    float lift = max(cubeHeight(face) - dot(face, entered), 0.0);
    float trust = smooth_one.is_flat * (1.0 - cube);
    if (trust > 0.0) {
      vec3 from_centre = place / cell_side - (vec3(cell) + 0.5);
      lift = mix(lift, smooth_one.height - dot(from_centre, face), trust);
    }
    place += face * (lift * cell_side);
  }
  vec3 start = u_show == SHOW_LIGHT || u_show == SHOW_OCCLUSION ? startPoint(place, face, cell_side, direction, depth)
                                                                : gridPoint(place);
  float value = steps;
  if (u_show == SHOW_LEVEL) value = float(hit.level);
  if (u_show == SHOW_SHARING) {
    uint code = hit.level >= u_levels - 1 ? texelFetch(u_leaf_instances, texel(hit.node), 0).x
                                          : texelFetch(u_node_instances, texel(hit.node), 0).x;
    value = float(code) / float(INSTANCE_STEPS);
  }
  out_start = vec4(start, cell_side);
  out_normal = vec4(normal, depth);
  out_face = vec4(packUnit(face), color, value);
}
