// Smooths what each pixel sees of sky and sun over its neighbours on the same surface, and lights it: the edges of depth and
// normal stay, and so do colours and normals, which are not smoothed.

uniform sampler2D u_seen, u_guide;    // of reproject.glsl
uniform sampler2D u_normal, u_face;   // of sample.glsl
uniform sampler2D u_start;
uniform int u_sun_radius;             // 0: the shadow of a small sun has edges to keep, and little noise

layout(location = 0) out vec4 out_sum;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 normal = texelFetch(u_normal, at, 0), face = texelFetch(u_face, at, 0), guide = texelFetch(u_guide, at, 0);
  vec3 direction = pixelDirection(pixelOfFragment());
  if (guide.w == 0.0) {
    out_sum = shaded(false, normal, face, normalize(direction), vec3(0.0), 1.0, 0.0);
    return;
  }
  vec3 away = direction * guide.z;
  float near = SMOOTH_NEAR * max(texelFetch(u_start, at, 0).w, u_pixel_size * guide.z);
  vec2 sum = vec2(0.0), weights = vec2(0.0);
  for (int y = -SMOOTH_RADIUS; y <= SMOOTH_RADIUS; ++y)
    for (int x = -SMOOTH_RADIUS; x <= SMOOTH_RADIUS; ++x) {
      ivec2 tap = at + ivec2(x, y);
      if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(u_size)))) continue;
      vec4 other = texelFetch(u_guide, tap, 0), seen = texelFetch(u_seen, tap, 0);
      if (other.w != guide.w) continue;
      vec3 there = pixelDirection(vec2(float(tap.x), u_size.y - 1.0 - float(tap.y))) * other.z;
      float weight = max(1.0 - abs(dot(normal.xyz, there - away)) / near, 0.0);
      float same = max(dot(unpackUnit(other.xy), normal.xyz), 0.0);
      same *= same; same *= same;
      weight *= same * same * exp(-float(x * x + y * y) / (0.7 * float(SMOOTH_RADIUS * SMOOTH_RADIUS)));
      vec2 each = vec2(weight * seen.z, max(abs(x), abs(y)) <= u_sun_radius ? weight * seen.w : 0.0);
      sum += each * seen.xy;
      weights += each;
    }
  vec2 seen = weights.x > 0.0 && weights.y > 0.0 ? sum / weights : texelFetch(u_seen, at, 0).xy;
  direction = normalize(direction);
  out_sum = shaded(true, normal, face, direction, skyLight(normal.xyz, -direction, seen.x), seen.x, seen.y * max(dot(normal.xyz, u_sun), 0.0));
}
