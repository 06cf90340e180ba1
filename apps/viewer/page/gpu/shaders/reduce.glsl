// Picks evenly spread pixels of a picture.
uniform sampler2D u_picture;
uniform vec2 u_from, u_to;  // sizes of the picture and of this one
layout(location = 0) out vec4 out_pixel;
void main() { out_pixel = texelFetch(u_picture, ivec2(floor(gl_FragCoord.xy * u_from / u_to)), 0); }
