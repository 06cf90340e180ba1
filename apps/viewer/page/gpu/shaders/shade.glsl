// The light that a view sample sends to the eye: the port of the shading of render/render_tile.hpp.

uniform int u_show;
uniform float u_least, u_most;                // the values that are shown darkest and brightest
uniform float u_view_distance;                // grid sides
uniform bool u_sky_occluded;
uniform vec3 u_fill;                          // to the viewer's right
uniform vec3 u_albedo;

vec3 srgbToLinear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}

// Returns the diffuse colour of a colour code of sample.glsl.
vec3 albedoOf(float code) {
  if (code >= 0.0) {
    uint rgb = uint(code);
    return srgbToLinear(vec3(float(rgb & 255u), float(rgb >> 8u & 255u), float(rgb >> 16u)) / 255.0);
  }
  return code < -1.5 ? CUT_ALBEDO * (code < -2.1 ? LIGHT_HATCH_SHADE : 1.0) : u_albedo;
}

vec3 skyLight(vec3 normal, vec3 view, float open) {
  vec3 light = skyAmbient(normal);
  if (u_sky_occluded) return light * (LIGHT_OPEN * open);
  return light * max(LIGHT_FILL + LIGHT_FILL_FACING * dot(normal, view) + LIGHT_FILL_ASIDE * dot(normal, u_fill), 0.0);
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

// Returns what a view sample adds to the picture, and whether it covers the sky. `sky` is the light of sky and surfaces,
// divided by pi, that arrives; `open` the part of the sky that the sample sees; `lit` the part of the sun, times the cosine.
vec4 shaded(bool is_hit, vec4 normal, vec4 face, vec3 direction, vec3 sky, float open, float lit) {
  vec3 radiance = vec3(0.0);
  float covered = is_hit ? 1.0 : 0.0;
  if (!is_hit) {
    // display.glsl puts the sky behind the surfaces.
    if (u_show == SHOW_STEPS) radiance = heat(face.w / u_most);
    if (u_show == SHOW_OCCLUSION) radiance = vec3(1.0);
  } else if (u_show == SHOW_LIGHT) {
    radiance = (sky + u_sun_light * lit) * albedoOf(face.z);
    if (face.z < -2.5) {  // The ground: its shadow darkens what lies behind.
      const vec3 luminance = EXPOSURE_LUMINANCE;
      vec3 light = skyLight(normal.xyz, -direction, open) + u_sun_light * lit;
      vec3 all = skyLight(normal.xyz, -direction, 1.0) + u_sun_light * max(dot(normal.xyz, u_sun), 0.0);
      covered = face.w * max(1.0 - dot(light, luminance) / dot(all, luminance), 0.0);
      radiance = vec3(0.0);
    }
  } else {
    radiance = shown(normal, face.w, -direction, open);
  }
  return vec4(radiance, covered);
}
