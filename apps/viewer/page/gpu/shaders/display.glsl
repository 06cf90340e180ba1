// Shows the picture: exposure, tone mapping, background, sRGB and dither, as render/tone_map.hpp,
// render_plan.cpp and image/dither.hpp do. A picture with fewer pixels than the canvas is enlarged.

uniform sampler2D u_sum;      // red, green and blue of surfaces, and how many samples hit one
uniform float u_samples;      // in the sum
uniform int u_tone;           // TONE_KIND_*
uniform int u_background;     // BACKGROUND_*
uniform vec3 u_forward, u_right, u_up;  // as in camera.glsl
uniform float u_sky_exposure; // factor that makes an environment as bright as the clear sky
uniform vec2 u_canvas, u_picture;  // sizes in pixels
uniform float u_exposure;     // 0: the sum holds display colours
layout(location = 0) out vec4 out_color;

vec3 neutral(vec3 rgb) {
  float brightest = max(rgb.x, max(rgb.y, rgb.z));
  float peak = brightest < 2.0 * NEUTRAL_FLOOR ? brightest * brightest / (4.0 * NEUTRAL_FLOOR) : brightest - NEUTRAL_FLOOR;
  rgb *= peak / max(brightest, 1e-10);
  if (peak < NEUTRAL_START) return rgb;
  float room = 1.0 - NEUTRAL_START;
  float to = 1.0 - room * room / (peak + room - NEUTRAL_START);
  return mix(vec3(to), rgb * (to / peak), 1.0 / (NEUTRAL_DESATURATION * (peak - to) + 1.0));
}

vec3 agx(vec3 rgb) {
  vec3 v = vec3(dot(AGX_IN_RED, rgb), dot(AGX_IN_GREEN, rgb), dot(AGX_IN_BLUE, rgb));
  vec3 x = clamp((log2(max(v, 1e-10)) - AGX_LOWEST) / (AGX_HIGHEST - AGX_LOWEST), 0.0, 1.0);
  v = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
  return pow(clamp(vec3(dot(AGX_OUT_RED, v), dot(AGX_OUT_GREEN, v), dot(AGX_OUT_BLUE, v)), 0.0, 1.0), vec3(2.2));
}

vec3 toneMap(vec3 x) {
  if (u_tone == TONE_KIND_AGX) return agx(x);
  vec3 y = u_tone == TONE_KIND_NEUTRAL ? neutral(x) : (x * (TONE_A * x + TONE_B)) / (x * (TONE_C * x + TONE_D) + TONE_E);
  return clamp(y, 0.0, 1.0);
}

vec3 background(ivec2 at) {
  if (u_background == BACKGROUND_GREY) return vec3(LIGHT_GREY);
  if (u_background == BACKGROUND_WHITE) return vec3(1.0);
  if (u_background == BACKGROUND_BLACK) return vec3(0.0);
  vec2 place = (vec2(at) + 0.5) / u_picture * 2.0 - 1.0;
  return toneMap(skyRadiance(normalize(u_forward + u_right * place.x + u_up * place.y)) * (EXPOSURE_SKY * u_sky_exposure));
}

// Surfaces and background are exposed apart, then mixed as light of the display.
vec3 toneMapped(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(u_picture) - 1);
  vec4 sum = texelFetch(u_sum, at, 0);
  if (u_exposure <= 0.0) return clamp(sum.rgb / u_samples, 0.0, 1.0);
  float coverage = sum.w / u_samples;
  vec3 surface = coverage > 0.0 ? toneMap(sum.rgb / sum.w * u_exposure) : vec3(0.0);
  return coverage < 1.0 ? mix(background(at), surface, coverage) : surface;
}

void main() {
  vec3 color;
  if (u_canvas == u_picture) {
    color = toneMapped(ivec2(gl_FragCoord.xy));
  } else {
    vec2 place = gl_FragCoord.xy * u_picture / u_canvas - 0.5;
    ivec2 at = ivec2(floor(place));
    vec2 part = place - floor(place);
    color = mix(mix(toneMapped(at), toneMapped(at + ivec2(1, 0)), part.x),
                mix(toneMapped(at + ivec2(0, 1)), toneMapped(at + ivec2(1, 1)), part.x), part.y);
  }
  if (u_exposure > 0.0)
    color = mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, color * 12.92, vec3(lessThanEqual(color, vec3(0.0031308))));
  vec2 pixel = vec2(floor(gl_FragCoord.x), u_canvas.y - 1.0 - floor(gl_FragCoord.y));
  float threshold = u_exposure > 0.0 ? fract(52.9829189 * fract(0.06711056 * pixel.x + 0.00583715 * pixel.y)) : 0.5;
  out_color = vec4(floor(color * 255.0 + threshold) / 255.0, 1.0);
}
