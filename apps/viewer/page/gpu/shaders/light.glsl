// Lights the view samples and adds them to the picture: the port of render/direct_light.hpp,
// ambient_occlusion.hpp, sky.hpp and render_tile.hpp.

uniform sampler2D u_start, u_normal, u_face;  // of sample.glsl
uniform sampler2D u_sum;                      // the sum of the samples before this one
uniform bool u_first;
uniform int u_show;
uniform float u_least, u_most;                // the values that are shown darkest and brightest
uniform float u_view_distance;                // grid sides
uniform int u_index;                          // of the view sample in its pixel
uniform int u_light_samples, u_occlusion_samples;  // rays per view sample
uniform int u_light_first;                    // the first sample of the sun in its table
uniform bool u_shadows, u_sky_occluded;
uniform vec3 u_sun, u_sun_u, u_sun_v;         // unit vector to the sun; radii of its disc at distance 1
uniform vec3 u_sun_light;                     // irradiance / pi
uniform vec3 u_zenith, u_horizon, u_ground, u_sky_up, u_fill;
uniform vec3 u_albedo;
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

vec3 unpackUnit(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}

vec3 srgbToLinear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}

vec3 skyLight(vec3 normal, vec3 view, float open) {
  vec3 light = mix(u_ground, mix(u_zenith, u_horizon, LIGHT_HORIZON_IN_DOME), 0.5 + 0.5 * dot(normal, u_sky_up));
  if (u_sky_occluded) return light * (LIGHT_OPEN * open);
  return light * max(LIGHT_FILL + LIGHT_FILL_FACING * dot(normal, view) + LIGHT_FILL_ASIDE * dot(normal, u_fill), 0.0);
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

// The colour scale of render/film/picture_pass.cpp: from black over blue, red and yellow to white.
vec3 heat(float value) {
  float v = clamp(value, 0.0, 1.0);
  float angle = 6.2831853 * (0.5 / 3.0 + 1.0 - 1.2 * v);
  float spread = 1.3 * v * (1.0 - v) * 0.5;
  float c = cos(angle) * spread, s = sin(angle) * spread;
  return clamp(vec3(v - 0.14861 * c + 1.78277 * s, v - 0.29227 * c - 0.90649 * s, v + 1.97294 * c), 0.0, 1.0);
}

// Returns the display colour of a value of the structure.
vec3 shown(vec4 normal, float value, vec3 view, float open) {
  if (u_show == SHOW_NORMAL) return normal.xyz * 0.5 + 0.5;
  if (u_show == SHOW_OCCLUSION) return vec3(open);
  if (u_show == SHOW_DEPTH) return vec3(0.08 + 0.92 / (1.0 + normal.w / u_view_distance));
  if (u_show == SHOW_STEPS) return heat(value / u_most);
  float facing = 0.55 + 0.45 * max(dot(normal.xyz, view), 0.0);
  return heat(0.12 + 0.8 * (value - u_least) / (u_most - u_least)) * facing;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 pixel = ivec2(pixelOfFragment());
  vec4 start = texelFetch(u_start, at, 0);
  vec4 normal = texelFetch(u_normal, at, 0);
  vec4 face = texelFetch(u_face, at, 0);
  vec3 direction = normalize(pixelDirection(vec2(pixel)));
  bool is_hit = start.w > 0.0, is_ground = face.z < -2.5;
  vec3 radiance = vec3(0.0);
  float covered = is_hit ? 1.0 : 0.0;
  if (!is_hit) {
    // display.glsl puts the sky behind the surfaces.
    if (u_show == SHOW_STEPS) radiance = heat(face.w / u_most);
    if (u_show == SHOW_OCCLUSION) radiance = vec3(1.0);
  } else {
    vec3 flat_normal = unpackUnit(face.xy);
    float open = 1.0;
    if (u_occlusion_samples > 0 && (u_show == SHOW_LIGHT || u_show == SHOW_OCCLUSION))
      open = openSky(start.xyz, normal.xyz, flat_normal, start.w, pixelSamples(pixel, 0u), is_ground);
    if (u_show == SHOW_LIGHT) {
      vec3 albedo = u_albedo;
      if (face.z >= 0.0) {
        uint code = uint(face.z);
        albedo = srgbToLinear(vec3(float(code & 255u), float(code >> 8u & 255u), float(code >> 16u)) / 255.0);
      } else if (face.z < -1.5) {
        albedo = CUT_ALBEDO * (face.z < -2.1 ? LIGHT_HATCH_SHADE : 1.0);
      }
      vec3 light = skyLight(normal.xyz, -direction, open);
      if (u_sun_light != vec3(0.0))
        light += u_sun_light * sunlight(start.xyz, normal.xyz, flat_normal, start.w, pixelSamples(pixel, 1u), is_ground);
      radiance = light * albedo;
      if (is_ground) {
        const vec3 luminance = EXPOSURE_LUMINANCE;
        vec3 all = skyLight(normal.xyz, -direction, 1.0) + u_sun_light * max(dot(normal.xyz, u_sun), 0.0);
        covered = face.w * max(1.0 - dot(light, luminance) / dot(all, luminance), 0.0);
        radiance = vec3(0.0);
      }
    } else {
      radiance = shown(normal, face.w, -direction, open);
    }
  }
  vec4 sum = vec4(radiance, covered);
  if (!u_first) sum += texelFetch(u_sum, at, 0);
  out_sum = sum;
}
