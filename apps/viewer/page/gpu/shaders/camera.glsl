// The camera of render/camera.hpp, in units of the grid's side and relative to its lower corner.

uniform vec3 u_eye, u_forward, u_right, u_up;
uniform vec2 u_size;           // of the picture, pixels
uniform vec2 u_sample;         // place of the sample in its pixel, in [0,1)
uniform float u_pixel_size;    // width of a pixel at depth 1
uniform float u_lod;           // cells of at most this many pixels end a ray

// Returns the direction through a pixel, counted from the top left corner; its part along forward is 1.
vec3 pixelDirection(vec2 pixel) {
  vec2 place = (pixel + u_sample) / u_size;
  return u_forward + u_right * (2.0 * place.x - 1.0) + u_up * (1.0 - 2.0 * place.y);
}

// Returns this invocation's pixel, counted from the top left corner.
vec2 pixelOfFragment() { return vec2(floor(gl_FragCoord.x), u_size.y - 1.0 - floor(gl_FragCoord.y)); }
