// Adds what each pixel sees of sky and sun to what the same place saw in the frames before. Reprojection, and the tests that
// reject a place that was hidden, follow Schied et al., Spatiotemporal Variance-Guided Filtering, HPG 2017, section 4.1.

uniform sampler2D u_seen;                     // of light.glsl, with u_only_visible
uniform sampler2D u_start, u_normal;          // of sample.glsl
uniform sampler2D u_old_seen, u_old_guide;    // what this shader wrote for the frame before
uniform vec3 u_old_eye, u_old_forward, u_old_right, u_old_up;  // its camera, as in camera.glsl
uniform vec2 u_old_size;
uniform int u_most_frames;                    // that count; 1: the frame before had another light or scene
uniform bool u_same_sun;

layout(location = 0) out vec4 out_seen;   // the parts of sky and sun that are seen; frames that count in each
layout(location = 1) out vec4 out_guide;  // xy: octahedral normal; z: depth; w: 0 nothing, 1 surface, 2 ground

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 start = texelFetch(u_start, at, 0), normal = texelFetch(u_normal, at, 0);
  out_seen = vec4(texelFetch(u_seen, at, 0).xy, 1.0, 1.0);
  out_guide = vec4(0.0);
  if (start.w <= 0.0) return;
  bool is_ground = normal.w < 0.0;
  vec3 away = is_ground ? start.xyz - 1.0 - u_eye : pixelDirection(pixelOfFragment()) * normal.w;
  float depth = dot(away, u_forward);
  out_guide = vec4(packUnit(normal.xyz), depth, is_ground ? 2.0 : 1.0);

  vec3 old_away = u_eye + away - u_old_eye;
  float old_depth = dot(old_away, u_old_forward);
  if (u_most_frames < 2 || old_depth <= 0.0) return;
  vec2 across = vec2(dot(old_away, u_old_right) / dot(u_old_right, u_old_right), dot(old_away, u_old_up) / dot(u_old_up, u_old_up));
  vec2 place = (across / old_depth * 0.5 + 0.5) * u_old_size - 0.5;
  ivec2 low = ivec2(floor(place));
  vec2 part = place - vec2(low);
  float near = SMOOTH_NEAR * max(start.w, u_pixel_size * depth);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 tap = low + ivec2(i & 1, i >> 1);
    if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(u_old_size)))) continue;
    vec4 guide = texelFetch(u_old_guide, tap, 0);
    vec2 ray = (vec2(tap) + 0.5) / u_old_size * 2.0 - 1.0;
    vec3 there = (u_old_forward + u_old_right * ray.x + u_old_up * ray.y) * guide.z;
    if (guide.w != out_guide.w || abs(dot(normal.xyz, there - old_away)) > near) continue;
    if (dot(unpackUnit(guide.xy), normal.xyz) < 0.8) continue;
    float weight = (tap.x == low.x ? 1.0 - part.x : part.x) * (tap.y == low.y ? 1.0 - part.y : part.y);
    sum += weight * texelFetch(u_old_seen, tap, 0);
    weights += weight;
  }
  if (weights < 0.01) return;
  vec4 old = sum / weights;
  vec2 frames = vec2(min(old.z, float(u_most_frames - 1)), u_same_sun ? min(old.w, float(u_most_frames - 1)) : 0.0) + 1.0;
  out_seen = vec4(mix(old.xy, out_seen.xy, 1.0 / frames), frames);
}
