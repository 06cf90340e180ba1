// Casts the rays of sun and sky from the view samples, and adds their light to the picture: the port of
// render/direct_light.hpp, ambient_occlusion.hpp, path_light.hpp and render_tile.hpp.

uniform sampler2D u_start, u_normal, u_face;  // of sample.glsl
uniform sampler2D u_sum;                      // the sum of the samples before this one
uniform bool u_first;
uniform bool u_only_visible;                  // write only which part of sky and sun each pixel sees, for smooth.glsl
uniform int u_index;                          // of the view sample in its pixel
uniform int u_light_samples, u_occlusion_samples;  // rays per view sample
uniform int u_light_first;                    // the first sample of the sun in its table
uniform bool u_shadows;
uniform int u_bounces;                        // with HAS_PATHS: how often light is reflected
uniform vec3 u_sun_u, u_sun_v;                // radii of the sun's disc at distance 1
uniform float u_occlusion_distance, u_occlusion_cone;
uniform sampler2D u_table;                    // of sample_tables.js; row: set
uniform int u_light_count, u_hemisphere_count;  // samples per set, in the columns of the table

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
PixelSamples samplesOfHash(uint bits) {
  int set = int(bits % uint(SAMPLES_SETS)), rotation = int(bits / uint(SAMPLES_SETS) % uint(SAMPLES_ROTATIONS));
  ivec2 at = ivec2(u_hemisphere_count + u_light_count + rotation / SAMPLES_SETS, rotation % SAMPLES_SETS);
  return PixelSamples(set, texelFetch(u_table, at, 0).xy);
}
PixelSamples pixelSamples(ivec2 pixel, uint purpose) {
  uint column = hashBits(uint(pixel.x));
  uint row = hashBits(column + uint(pixel.y));
  return samplesOfHash(hashBits(row + purpose * 0x9E3779B9u));
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

// Returns the direction towards place `i` of the sun's disc.
vec3 sunPlace(PixelSamples pixel, int i) {
  vec2 p = rotated(pixel, texelFetch(u_table, ivec2(u_hemisphere_count + i, pixel.set), 0).xy);
  return u_sun + u_sun_u * p.x + u_sun_v * p.y;
}

// A point of a surface, or of the ground.
struct SurfacePoint {
  vec3 start, normal, face;
  float cell_side;
  bool is_ground;
};

// Returns the part of the light from a place of the sun that arrives, times the cosine at the surface.
float litFrom(SurfacePoint point, vec3 direction) {
  float above = dot(point.normal, direction);
  if (!(above > 0.0 && dot(point.face, direction) > 0.0)) return 0.0;
  CellHit hit;
  if (u_shadows && castRay(rayFrom(point.start, direction, 3e38, point.is_ground), point.cell_side, 0.0, hit)) return 0.0;
  return above / length(direction);
}

// Returns a direction of the hemisphere around (0,0,1), turned to the normal and mirrored at the plane of the face.
vec3 aroundNormal(vec3 normal, vec3 face, vec3 local) {
  float s = normal.z < 0.0 ? -1.0 : 1.0;
  float a = -1.0 / (s + normal.z), b = normal.x * normal.y * a;
  vec3 u = vec3(1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x);
  vec3 v = vec3(b, s + normal.y * normal.y * a, -normal.y);
  vec3 direction = u * local.x + v * local.y + normal * local.z;
  float above = dot(direction, face);
  return above < 0.0 ? direction - face * (2.0 * above) : direction;
}

// Returns occlusion ray `i` of a pixel around (0,0,1); w: its length, as a part of the longest.
vec4 hemisphereRay(PixelSamples pixel, int i) {
  vec4 ray = texelFetch(u_table, ivec2(i, pixel.set), 0);
  return vec4(rotated(pixel, ray.xy), ray.zw);
}

#ifdef HAS_PATHS
uint g_random;
void seedRandom(ivec2 pixel, int path, int bounce) {
  g_random = hashBits(hashBits(hashBits(hashBits(uint(pixel.x)) + uint(pixel.y)) + uint(path)) + uint(bounce));
}
uint nextRandom() { return g_random = hashBits(g_random + 0x9E3779B9u); }
float nextSigned() { return (float(nextRandom() >> 8u) + 0.5) / 8388608.0 - 1.0; }

vec3 cosineDirection() {
  for (int i = 0; i < 32; ++i) {
    vec2 p;
    p.x = nextSigned();
    p.y = nextSigned();
    float up2 = 1.0 - dot(p, p);
    if (up2 > 0.0) return vec3(p, sqrt(up2));
  }
  return vec3(0.0, 0.0, 1.0);
}

// Returns the light of sky and surfaces that paths from a point bring, divided by pi, and the part of the paths that leave the
// scene at once.
vec3 pathLight(SurfacePoint from, ivec2 pixel, out float open) {
  PixelSamples samples = pixelSamples(pixel, 0u);
  vec3 gathered = vec3(0.0);
  int left = 0;
  for (int k = 0; k < u_occlusion_samples; ++k) {
    int path = u_index * u_occlusion_samples + k;
    SurfacePoint point = from;
    vec3 carried = vec3(1.0);
    for (int bounce = 0; bounce <= u_bounces; ++bounce) {
      seedRandom(pixel, path, bounce);
      vec3 local = bounce == 0 ? hemisphereRay(samples, path).xyz : cosineDirection();
      vec3 direction = aroundNormal(point.normal, point.face, local), origin = point.start - 1.0;
      GridRay ray = rayFrom(point.start, direction, 3e38, point.is_ground);
      CellHit hit;
      if (!castRay(ray, point.cell_side, 0.0, hit)) {
        if (bounce == 0) ++left;
        gathered += carried * skyRadiance(normalize(direction));
        break;
      }
      if (bounce == u_bounces) break;
      float t = ray.t_start + hit.t * ray.t_scale;
      ViewSample seen = viewSample(ray, hit, origin, direction, t, length(origin + direction * t - u_eye));
      point = SurfacePoint(startPoint(seen, origin, direction, t), seen.normal, seen.face, seen.cell_side, false);
      carried *= albedoOf(seen.color);
      if (u_sun_light == vec3(0.0)) continue;
      seedRandom(pixel, path, (bounce + 1) * 32);
      PixelSamples place = samplesOfHash(nextRandom());
      gathered += carried * u_sun_light * litFrom(point, sunPlace(place, int(nextRandom() % uint(u_light_count))));
    }
  }
  open = float(left) / float(u_occlusion_samples);
  return gathered / float(u_occlusion_samples);
}
#else
// Returns the part of the sky's light that no near surface occludes.
float openSky(SurfacePoint point, PixelSamples pixel) {
  int open = 0;
  for (int i = 0; i < u_occlusion_samples; ++i) {
    vec4 local = hemisphereRay(pixel, u_index * u_occlusion_samples + i);
    vec3 direction = aroundNormal(point.normal, point.face, local.xyz);
    GridRay short_ray = rayFrom(point.start, direction, local.w * u_occlusion_distance, point.is_ground);
    CellHit hit;
    if (!castRay(short_ray, point.cell_side, u_occlusion_cone * short_ray.t_scale, hit)) ++open;
  }
  return float(open) / float(u_occlusion_samples);
}
#endif

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 pixel = ivec2(pixelOfFragment());
  vec4 start = texelFetch(u_start, at, 0);
  vec4 normal = texelFetch(u_normal, at, 0);
  vec4 face = texelFetch(u_face, at, 0);
  bool is_hit = start.w > 0.0;
  vec3 to_viewer = -normalize(pixelDirection(vec2(pixel))), sky = vec3(0.0);
  float open = 1.0, lit = 0.0;
  if (is_hit) {
    SurfacePoint point = SurfacePoint(start.xyz, normal.xyz, unpackUnit(face.xy), start.w, face.z < -2.5);
#ifdef HAS_PATHS
    sky = pathLight(point, pixel, open);
#else
    if (u_occlusion_samples > 0 && (u_show == SHOW_LIGHT || u_show == SHOW_OCCLUSION)) open = openSky(point, pixelSamples(pixel, 0u));
    sky = skyLight(normal.xyz, to_viewer, open);
#endif
    if (u_show == SHOW_LIGHT && u_sun_light != vec3(0.0)) {
      PixelSamples samples = pixelSamples(pixel, 1u);
      for (int i = 0; i < u_light_samples; ++i) lit += litFrom(point, sunPlace(samples, u_light_first + i));
      lit /= float(u_light_samples);
    }
  }
  if (u_only_visible) {
    float above = dot(normal.xyz, u_sun);
    out_sum = vec4(open, above > 0.0 ? min(lit / above, 1.0) : 0.0, 0.0, 1.0);
    return;
  }
  vec4 sum = shaded(is_hit, normal, face, -to_viewer, sky, open, lit);
  if (!u_first) sum += texelFetch(u_sum, at, 0);
  out_sum = sum;
}
