// Shows the picture: exposure, tone mapping, sRGB and dither, as render/tone_map.hpp and
// image/dither.hpp do. A picture with fewer pixels than the canvas is enlarged.

precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D u_sum;
uniform float u_samples;      // in the sum
uniform vec2 u_canvas, u_picture;  // sizes in pixels
uniform float u_exposure;     // 0: the sum holds display colours
layout(location = 0) out vec4 out_color;

vec3 toneMapped(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(u_picture) - 1);
  vec3 x = texelFetch(u_sum, at, 0).rgb / u_samples;
  if (u_exposure <= 0.0) return clamp(x, 0.0, 1.0);
  x *= u_exposure;
  return clamp((x * (TONE_A * x + TONE_B)) / (x * (TONE_C * x + TONE_D) + TONE_E), 0.0, 1.0);
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
