// The light from outside the scene: the port of render/sky.hpp.

uniform vec3 u_sun;                           // unit vector to the sun
uniform vec3 u_sun_light;                     // irradiance / pi
uniform vec3 u_zenith, u_horizon, u_ground, u_sky_up;
uniform sampler2D u_map;                      // octahedral, of an environment
uniform int u_map_side;                       // 0: the clear sky
uniform vec3 u_map_right, u_map_back;         // its axes x and z; y is u_sky_up
uniform vec3 u_harmonics[9];                  // of the map, with the factor on the sky
uniform float u_map_scale;

// octahedral_texel().
vec3 mapTexel(ivec2 at) {
  int last = u_map_side - 1;
  if (at.x < 0 || at.x > last) at = ivec2(clamp(at.x, 0, last), last - at.y);
  if (at.y < 0 || at.y > last) at = ivec2(last - at.x, clamp(at.y, 0, last));
  return texelFetch(u_map, at, 0).rgb;
}

vec3 inMap(vec3 v) { return vec3(dot(v, u_map_right), dot(v, u_sky_up), dot(v, u_map_back)); }

vec3 mapRadiance(vec3 direction) {
  vec3 d = inMap(direction);
  vec2 place = d.xz / (abs(d.x) + abs(d.y) + abs(d.z));
  if (d.y < 0.0) place = (1.0 - abs(place.yx)) * vec2(place.x < 0.0 ? -1.0 : 1.0, place.y < 0.0 ? -1.0 : 1.0);
  place = (place + 1.0) * 0.5 * float(u_map_side) - 0.5;
  ivec2 at = ivec2(floor(place));
  vec2 part = place - floor(place);
  return mix(mix(mapTexel(at), mapTexel(at + ivec2(1, 0)), part.x),
             mix(mapTexel(at + ivec2(0, 1)), mapTexel(at + ivec2(1, 1)), part.x), part.y) * u_map_scale;
}

// Returns the radiance along a ray that leaves the scene.
vec3 skyRadiance(vec3 direction) {
  if (u_map_side > 0) return mapRadiance(direction);
  float height = dot(direction, u_sky_up);
  float haze = 1.0 - max(height, 0.0);
  vec3 radiance = mix(u_zenith, u_horizon, haze * haze * haze * haze);
  float glow = max(dot(direction, u_sun), 0.0);
  glow *= glow;
  radiance += u_sun_light * (LIGHT_GLOW * glow * glow * glow * glow);
  float t = clamp((height - LIGHT_GROUND_BEGINS) / (LIGHT_GROUND_IS_FULL - LIGHT_GROUND_BEGINS), 0.0, 1.0);
  return mix(radiance, u_ground * LIGHT_GROUND_SEEN, t * t * (3.0 - 2.0 * t));
}

// Returns the irradiance, divided by pi, on a surface that nothing hides.
vec3 skyAmbient(vec3 normal) {
  if (u_map_side == 0)
    return mix(u_ground, mix(u_zenith, u_horizon, LIGHT_HORIZON_IN_DOME), 0.5 + 0.5 * dot(normal, u_sky_up));
  vec3 n = inMap(normal);
  return max(u_harmonics[0] + u_harmonics[1] * n.x + u_harmonics[2] * n.y + u_harmonics[3] * n.z + u_harmonics[4] * (n.x * n.y) +
             u_harmonics[5] * (n.y * n.z) + u_harmonics[6] * (n.z * n.x) + u_harmonics[7] * (n.x * n.x - n.y * n.y) +
             u_harmonics[8] * (3.0 * n.z * n.z - 1.0), 0.0);
}
