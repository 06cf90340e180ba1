// The surface that a ray hit, ready to be lit: the port of render/voxel_view_samples.hpp.

uniform float u_cube_pixels;
uniform float u_hatch_period;               // of the lines on cut faces, in grid sides; 0: none
uniform int u_color_bits, u_normal_bits;  // precision of the stored values; -1: none
uniform usampler2D u_color_words, u_color_pages, u_normal_words, u_normal_pages;
uniform uint u_color_overlay, u_normal_overlay;

struct ViewSample {
  vec3 place;         // relative to the grid's corner, in its sides; on the surface or above it
  vec3 normal, face;  // for shading, and of the face
  float color;        // 8 bits each of red, green and blue; -1: none, -2: cut, -2.25: cut, on a line of the hatching
  float cell_side;
};

// is_hatched() of render/hatch.hpp.
bool isHatched(vec3 place, vec3 normal) {
  if (u_hatch_period <= 0.0) return false;
  vec3 size = abs(normal);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return fract((place.x + place.y + place.z - place[axis]) / u_hatch_period) < LIGHT_HATCH_WIDTH;
}

// Returns the sample at which a ray along from + t * direction hit a cell. `depth` is the distance from the camera that decides
// how smooth the cell looks.
ViewSample viewSample(GridRay ray, CellHit hit, vec3 from, vec3 direction, float t, float depth) {
  float cell_side = uintBitsToFloat(uint(127 - hit.level) << 23u);
  vec3 view = -normalize(direction);
  vec3 place = from + direction * t;
  if (ray.cut != 0 && hit.t == ray.t_min) {
    vec3 cut = ray.cut == 4 ? u_section_plane.xyz : vec3(0.0);
    if (ray.cut < 4) cut[ray.cut - 1] = direction[ray.cut - 1] > 0.0 ? -1.0 : 1.0;
    return ViewSample(place, cut, cut, isHatched(place, cut) ? -2.25 : -2.0, cell_side);
  }
  int side = enteredFace(ray, hit);
  vec3 entered = side < 0 ? view : faceNormal(side);
  ivec3 cell = cellOf(ray, hit);
  float cell_pixels = cell_side / (u_pixel_size * depth);
  float cube = smoothStep(u_cube_pixels * 0.5, u_cube_pixels, cell_pixels);
  vec3 normal = entered;
  SmoothSurface smooth_one = SmoothSurface(entered, 0.0, 0.0);
  if (cube < 1.0 && hit.level >= 2) {
    smooth_one = smoothSurface(hit.level, cell, view, entered);
    normal = normalize(mix(smooth_one.normal, entered, cube));
  }
  vec3 face = normal;
  float color = -1.0;
#ifdef HAS_LOOK
  if (u_finest >= 0) {
    uint number;
    uvec3 value;
    bool is_stored = findNumber(cell, hit.level, number);
    if (u_channel >= 0) {
      if (is_stored) color = dot(channelColor(u_color_words, number), vec3(1.0, 256.0, 65536.0));
    } else if (u_color_bits >= 0 &&
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
  return ViewSample(place + face * (lift * cell_side), normal, face, color, cell_side);
}

bool isHidden(vec3 start, float cell_side, vec3 to_viewer) {
  CellHit hit;
  return castRay(rayFromPoint(start, to_viewer, 0.0, START_HIDDEN * cell_side), cell_side, 0.0, hit);
}

// Returns the point at which shadow and occlusion rays of a sample start, which is seen at from + t * direction: the port of
// render/surface_point.hpp.
vec3 startPoint(ViewSample seen, vec3 from, vec3 direction, float t) {
  float cell_side = seen.cell_side;
  vec3 lifted = seen.place + seen.face * ((cubeHeight(seen.face) + START_SLACK) * cell_side);
  vec3 to_viewer = -normalize(direction);
  float cell_depth = cell_side / length(direction);
  vec3 left = to_viewer;
  int axis = 0;
  vec3 start = gridPoint(lifted);
  // 0: lifted; 1..3: towards the viewer; 4..9: along the axes; 10..12: farther towards the viewer.
  for (int attempt = 0; attempt < 13; ++attempt) {
    vec3 there = lifted;
    if (attempt >= 1 && attempt <= 3) {
      there = from + direction * (t - float(attempt) * cell_depth);
    } else if (attempt >= 4 && attempt <= 9) {
      bool first = (attempt & 1) == 0;
      if (first) {
        vec3 size = abs(left);
        axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      }
      there[axis] += (left[axis] < 0.0 ? -1.0 : 1.0) * (first ? 1.0 : 2.0) * cell_side;
      if (!first) left[axis] = 0.0;
    } else if (attempt >= 10) {
      float cells = attempt == 10 ? 4.0 : attempt == 11 ? 6.0 : 9.0;
      there = from + direction * (t - cells * cell_depth);
    }
    start = gridPoint(there);
    if (!isHidden(start, cell_side, to_viewer)) break;
  }
  return start;
}
