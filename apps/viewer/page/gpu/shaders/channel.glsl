// The colour of a channel's value: the port of stored/attributes/channels.hpp and channel_colors.cpp. The halves of the
// channel's words lie in u_color_words.

uniform int u_channel;          // -1: none; its numbers are 0: values, 1: values in steps, or codes of floats, 2: codes of floats
uniform uint u_channel_packed;  // where the packed values begin
uniform int u_least_number;     // of the first colour
uniform vec4 u_channel_scale;   // numbers: what the first colour is above u_least_number, the range; floats: half the least, half the range

vec3 channelColor(highp usampler2D words, uint number) {
  uint block = 4u * (number / uint(CHANNELS_BLOCK_VALUES));
  uint flags = texelFetch(words, texel(block + 3u), 0).x, width = flags & 63u;
  BitPlace place = BitPlace(u_channel_packed + 2u * texelFetch(words, texel(block), 0).x, 0u);
  skipBits(place, number % uint(CHANNELS_BLOCK_VALUES) * width);
  uint above = bitsAt(words, place, min(width, 16u));
  if (width > 16u) {
    skipBits(place, 16u);
    above |= bitsAt(words, place, width - 16u) << 16u;
  }
  uint code = texelFetch(words, texel(block + 2u), 0).x + above;
  float at;
  if (u_channel == 2 || (u_channel == 1 && (flags >> 6u & 1u) != 0u)) {
    float value = uintBitsToFloat((code & 0x80000000u) != 0u ? code ^ 0x7FFFFFFFu : code);
    at = (0.5 * value - u_channel_scale.z) / u_channel_scale.w;
  } else {
    at = int(code) < u_least_number ? 0.0 : (float(code - uint(u_least_number)) - u_channel_scale.x) / u_channel_scale.y;
  }
  const vec3 colors[] = vec3[](CHANNEL_COLORS);
  at = clamp(at, 0.0, 1.0) * float(colors.length() - 1);
  int first = min(int(at), colors.length() - 2);
  return floor(mix(colors[first], colors[first + 1], at - float(first)) + 0.5);
}
