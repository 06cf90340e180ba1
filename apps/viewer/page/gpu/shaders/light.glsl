// Casts the rays of sun and sky from the view samples, and adds their light to the picture: the port of
// render/direct_light.hpp, ambient_occlusion.hpp and render_tile.hpp.

uniform sampler2D u_start, u_normal, u_face;  // of sample.glsl
uniform sampler2D u_sum;                      // the sum of the samples before this one
uniform bool u_first;
uniform bool u_only_visible;                  // write only which part of sky and sun each pixel sees, for smooth.glsl
uniform int u_index;                          // of the view sample in its pixel
uniform int u_light_samples, u_occlusion_samples;  // rays per view sample
uniform int u_light_first;                    // the first sample of the sun in its table
uniform bool u_shadows;
uniform vec3 u_sun_u, u_sun_v;                // radii of the sun's disc at distance 1
uniform float u_occlusion_distance, u_occlusion_cone;
uniform sampler2D u_disc, u_hemisphere, u_rotations;  // column: index of the sample; row: set

layout(location = 0) out vec4 out_sum;

uint hashBits(uint v) {
  v ^= v >> 16u;
  v *= 0x7FEB352Du;
  v ^= v >> 15u;
  v *= 0x846CA68Bu;
  return v ^ v >> 16u;
}

struct PixelSamples {
  int set;
  vec2 rotation;
};
PixelSamples pixelSamples(ivec2 pixel, uint purpose) {
  uint column = hashBits(uint(pixel.x));
  uint row = hashBits(column + uint(pixel.y));
  uint bits = hashBits(row + purpose * 0x9E3779B9u);
  uint rotation = bits / uint(SAMPLES_SETS) % uint(SAMPLES_ROTATIONS);
  return PixelSamples(int(bits % uint(SAMPLES_SETS)), texelFetch(u_rotations, ivec2(int(rotation), 0), 0).xy);
}
vec2 rotated(PixelSamples pixel, vec2 p) {
  return vec2(p.x * pixel.rotation.x - p.y * pixel.rotation.y, p.x * pixel.rotation.y + p.y * pixel.rotation.x);
}

// Returns a ray from a surface, or from the ground, which may lie outside the grid.
GridRay rayFrom(vec3 start, vec3 direction, float t_max, bool is_ground) {
  if (!is_ground) return rayFromPoint(start, direction, 0.0, t_max);
  GridRay ray = rayFromEye(start - 1.0, direction);
  ray.t_max = min(ray.t_max, (t_max - ray.t_start) / ray.t_scale);
  return ray;
}

// Returns the part of the sun's light that arrives, times the cosine at the surface.
float sunlight(vec3 start, vec3 normal, vec3 face, float cell_side, PixelSamples pixel, bool is_ground) {
  float lit = 0.0;
  for (int i = 0; i < u_light_samples; ++i) {
    vec2 p = rotated(pixel, texelFetch(u_disc, ivec2(u_light_first + i, pixel.set), 0).xy);
    vec3 direction = u_sun + u_sun_u * p.x + u_sun_v * p.y;
    float above = dot(normal, direction);
    if (!(above > 0.0 && dot(face, direction) > 0.0)) continue;
    CellHit hit;
    if (u_shadows && castRay(rayFrom(start, direction, 3e38, is_ground), cell_side, 0.0, hit)) continue;
    lit += above / length(direction);
  }
  return lit / float(u_light_samples);
}

// Returns the part of the sky's light that no near surface occludes.
float openSky(vec3 start, vec3 normal, vec3 face, float cell_side, PixelSamples pixel, bool is_ground) {
  float s = normal.z < 0.0 ? -1.0 : 1.0;
  float a = -1.0 / (s + normal.z), b = normal.x * normal.y * a;
  vec3 u = vec3(1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x);
  vec3 v = vec3(b, s + normal.y * normal.y * a, -normal.y);
  int open = 0;
  for (int i = 0; i < u_occlusion_samples; ++i) {
    vec4 ray = texelFetch(u_hemisphere, ivec2(u_index * u_occlusion_samples + i, pixel.set), 0);
    vec2 flat_part = rotated(pixel, ray.xy);
    vec3 direction = u * flat_part.x + v * flat_part.y + normal * ray.z;
    float above = dot(direction, face);
    if (above < 0.0) direction -= face * (2.0 * above);
    GridRay short_ray = rayFrom(start, direction, ray.w * u_occlusion_distance, is_ground);
    CellHit hit;
    if (!castRay(short_ray, cell_side, u_occlusion_cone * short_ray.t_scale, hit)) ++open;
  }
  return float(open) / float(u_occlusion_samples);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 pixel = ivec2(pixelOfFragment());
  vec4 start = texelFetch(u_start, at, 0);
  vec4 normal = texelFetch(u_normal, at, 0);
  vec4 face = texelFetch(u_face, at, 0);
  bool is_hit = start.w > 0.0, is_ground = face.z < -2.5;
  float open = 1.0, lit = 0.0;
  if (is_hit) {
    vec3 flat_normal = unpackUnit(face.xy);
    if (u_occlusion_samples > 0 && (u_show == SHOW_LIGHT || u_show == SHOW_OCCLUSION))
      open = openSky(start.xyz, normal.xyz, flat_normal, start.w, pixelSamples(pixel, 0u), is_ground);
    if (u_show == SHOW_LIGHT && u_sun_light != vec3(0.0))
      lit = sunlight(start.xyz, normal.xyz, flat_normal, start.w, pixelSamples(pixel, 1u), is_ground);
  }
  if (u_only_visible) {
    float above = dot(normal.xyz, u_sun);
    out_sum = vec4(open, above > 0.0 ? min(lit / above, 1.0) : 0.0, 0.0, 1.0);
    return;
  }
  vec4 sum = shaded(is_hit, normal, face, normalize(pixelDirection(vec2(pixel))), open, lit);
  if (!u_first) sum += texelFetch(u_sum, at, 0);
  out_sum = sum;
}
