// Colours and normals of cells: the port of stored/attributes/cell_index_lookup.hpp, value_pages.hpp, value_overlay.hpp and
// look.hpp.
// Numbers of cells and byte addresses fit into 32 bits (the loader takes care of it).

uniform usampler2D u_slots;    // r: the words of CIDX, 32 bits each
uniform int u_slot_width[DAG_MAX_LEVELS];
uniform uint u_slot_begin[DAG_MAX_LEVELS];   // in words of 32 bits
uniform uint u_level_begin[DAG_MAX_LEVELS];  // in words of NODE
uniform int u_finest;          // m, the finest level with attributes; -1 without attributes

uint slotWord(uint i) { return texelFetch(u_slots, texel(i), 0).x; }

// Returns the slot beside word `word` of a node of `level`.
uint cellSum(int level, uint word) {
  uint width = uint(u_slot_width[level]);
  if (width == 0u) return 0u;
  uint slot = word - u_level_begin[level];
  uint bit = (slot & 31u) * width;
  uint at = u_slot_begin[level] + (slot >> 5u) * width + (bit >> 5u);
  uint shift = bit & 31u;
  uint value = slotWord(at) >> shift;
  if (shift + width > 32u) value |= slotWord(at + 1u) << (32u - shift);
  return width == 32u ? value : value & ((1u << width) - 1u);
}

uint childIndex(ivec3 cell, int shift) {
  ivec3 b = cell >> shift & 1;
  return uint(b.x | b.y << 1 | b.z << 2);
}

uint bitCount32(uint v) {
  v = v - (v >> 1u & 0x55555555u);
  v = (v & 0x33333333u) + (v >> 2u & 0x33333333u);
  v = (v + (v >> 4u)) & 0x0F0F0F0Fu;
  return (v * 0x01010101u) >> 24u;
}

// Returns the part of a leaf block below octant `octant`.
uvec2 blockBefore(uvec2 block, uint octant) {
  if (octant < 4u) return uvec2(block.x & ((1u << (8u * octant)) - 1u), 0u);
  return uvec2(block.x, block.y & ((1u << (8u * (octant - 4u))) - 1u));
}

// Finds the number of a cell of the DAG as it was read. Cells finer than m have their ancestor's number. Returns false if
// that DAG has no such cell.
bool findNumber(ivec3 cell, int level, out uint number) {
  int last = min(level, u_finest);
  uint at = 0u, sum = 0u;
  number = 0u;
  for (int l = 0; l < last; ++l) {
    uint child = childIndex(cell, level - 1 - l);
    if (l < u_levels - DAG_LEAF_LEVELS) {
      uint mask = nodeWord(at);
      if ((mask >> child & 1u) == 0u) return false;
      uint before = bitCount8(mask & ((1u << child) - 1u));
      if (before == 0u)
        sum += 1u;
      else if (l + 1 < u_finest)
        sum += cellSum(l, at + before);
      else
        sum += 1u + before;
      at = nodeWord(at + 1u + before);
      continue;
    }
    uvec2 block = leafBlock(at);
    uint octant = octantMask(block, child);
    if (octant == 0u) return false;
    uvec2 earlier = blockBefore(block, child);
    sum += 1u + bitCount8(octantsOf(earlier));
    if (u_finest == u_levels) {
      sum += bitCount32(earlier.x) + bitCount32(earlier.y);
      if (last == u_levels) {
        uint voxel = childIndex(cell, 0);
        if ((octant >> voxel & 1u) == 0u) return false;
        sum += 1u + bitCount8(octant & ((1u << voxel) - 1u));
      }
    }
    break;
  }
  number = sum;
  return true;
}

// Values that edits gave to cells. A reference is 0: the stored values; at least kOverlayValue: a value; else words.
uniform usampler2D u_overlay;
const uint kOverlayValue = 0x80000000u;

bool isWords(uint reference) { return reference != 0u && reference < kOverlayValue; }
uint overlayWord(uint reference, uint child) { return texelFetch(u_overlay, texel(8u * reference + child), 0).x; }

// Returns what the overlay with a root says of a cell. `is_stored`: the DAG as it was read has the cell.
uint overlayAt(uint reference, ivec3 cell, int level, bool is_stored) {
  for (int l = 0; l < level && isWords(reference); ++l) reference = overlayWord(reference, childIndex(cell, level - 1 - l));
  // The cell has no value itself: those of its parts stand for it.
  while (!is_stored && isWords(reference)) {
    uint child = 0u;
    while (child < 7u && overlayWord(reference, child) == 0u) ++child;
    reference = overlayWord(reference, child);
  }
  return reference;
}

// The channel that is shown, whose values lie in u_color_words: those of the first and the last colour.
uniform int u_channel;        // 0: whole numbers, 1: floats, -1: none
uniform int u_channel_least;  // whole numbers count from here on
uniform vec2 u_channel_ends;  // of floats, half of both: their difference is a float

// mapped_color() of stored/attributes/channel_colors.cpp.
vec3 channelColor(highp usampler2D values, uint number) {
  const vec3 colors[] = vec3[](CHANNEL_COLORS);
  uint code = texelFetch(values, texel(number), 0).x;
  float at = u_channel == 1 ? 0.5 * uintBitsToFloat(code) : int(code) < u_channel_least ? u_channel_ends.x : float(code - uint(u_channel_least));
  at = clamp((at - u_channel_ends.x) / (u_channel_ends.y - u_channel_ends.x), 0.0, 1.0) * float(colors.length() - 1);
  int first = min(int(at), colors.length() - 2);
  return floor(mix(colors[first], colors[first + 1], at - float(first)) + 0.5);
}

// A place in the words of values.
struct BitPlace {
  uint word, bit;
};
void skipBits(inout BitPlace place, uint bits) {
  place.bit += bits;
  place.word += place.bit >> 5u;
  place.bit &= 31u;
}
uint bitsAt(highp usampler2D words, BitPlace place, uint count) {
  if (count == 0u) return 0u;
  uint value = texelFetch(words, texel(place.word), 0).x >> place.bit;
  if (place.bit + count > 32u) value |= texelFetch(words, texel(place.word + 1u), 0).x << (32u - place.bit);
  return value & ((1u << count) - 1u);
}

uint channelBits(uint end_code, int channel) {
  uint fine = end_code & 3u;
  return fine > 0u ? fine + 5u : channel == 1 ? 6u : 5u;
}
uvec3 unpackEnd(uint end, uint end_code) {
  uvec3 value;
  for (int c = 0; c < 3; ++c) {
    uint bits = channelBits(end_code, c);
    uint field = end & ((1u << bits) - 1u);
    end >>= bits;
    value[c] = (field << (8u - bits) | field >> (2u * bits - 8u)) & 0xFFu;
  }
  return value;
}

// Returns the value with this number, as three integers of 8 bits. `pages` has the first byte of each page.
uvec3 readValue(highp usampler2D words, highp usampler2D pages, uint end_code, uint number) {
  uint begin = texelFetch(pages, texel(number / uint(PAGES_PAGE_VALUES)), 0).x;
  uint index = number % uint(PAGES_PAGE_VALUES);
  uint fine = end_code & 3u, end_bits = fine > 0u ? 3u * (fine + 5u) : 16u;
  bool any_length = end_code > 3u;
  uint header_bits = uint(PAGES_TYPE_BITS) + (any_length ? 8u : 6u), unit = any_length ? 1u : 4u;
  BitPlace place = BitPlace(begin >> 2u, (begin & 3u) * 8u);
  uint type = 0u;
  for (int i = 0; i < PAGES_PAGE_VALUES; ++i) {
    uint header = bitsAt(words, place, header_bits);
    type = header & 7u;
    uint len = unit * ((header >> 3u) + 1u);
    skipBits(place, header_bits);
    if (index < len) break;
    index -= len;
    uint weight = type == 0u || type == 4u ? 0u : type < 4u ? type : type - 3u;
    uint ends = type == 0u ? end_bits : type == 4u ? len * end_bits
              : type < 4u ? end_bits + uint(PAGES_STEP_BITS) : 2u * end_bits;
    skipBits(place, ends + weight * len);
  }
  if (type == 4u) skipBits(place, index * end_bits);
  uvec3 e0 = unpackEnd(bitsAt(words, place, end_bits), end_code);
  if (type == 0u || type == 4u) return e0;
  skipBits(place, end_bits);
  uvec3 e1;
  if (type < 4u) {
    uint step = bitsAt(words, place, uint(PAGES_STEP_BITS));
    e1 = min(e0 + uint(PAGES_STEP_UNIT) * (step + 1u), uvec3(255u));
    skipBits(place, uint(PAGES_STEP_BITS));
  } else {
    e1 = unpackEnd(bitsAt(words, place, end_bits), end_code);
    skipBits(place, end_bits);
  }
  uint w = type < 4u ? type : type - 3u;
  skipBits(place, index * w);
  uint k = bitsAt(words, place, w), most = (1u << w) - 1u;
  return (2u * (e0 * (most - k) + e1 * k) + most) / (2u * most);
}

// Reads a value of a cell: that of the overlay with a root, else the stored one. Returns false if there is none.
bool readLook(uint overlay, ivec3 cell, int level, bool is_stored, uint number, highp usampler2D words, highp usampler2D pages,
              uint end_code, out uvec3 value) {
  uint reference = overlayAt(overlay, cell, level, is_stored);
  value = uvec3(reference, reference >> 8u, reference >> 16u) & 0xFFu;
  if (reference >= kOverlayValue) return true;
  if (is_stored) value = readValue(words, pages, end_code, number);
  return is_stored;
}
