// Cells whose material is hidden: the port of read_material() in stored/attributes/material_ids.hpp.

uniform usampler2D u_material_words, u_material_pages, u_hidden_materials;  // the last: 1 for each id that is hidden
uniform int u_material_bits;  // of an id
uniform uint u_material_overlay;

uint materialOf(uint number) {
  uint begin = texelFetch(u_material_pages, texel(number / uint(PAGES_PAGE_VALUES)), 0).x;
  uint left = number % uint(PAGES_PAGE_VALUES), id = 0u;
  BitPlace place = BitPlace(begin >> 2u, (begin & 3u) * 8u);
  for (int i = 0; i < PAGES_PAGE_VALUES; ++i) {
    id = bitsAt(u_material_words, place, uint(u_material_bits));
    skipBits(place, uint(u_material_bits));
    if (bitsAt(u_material_words, place, 1u) != 0u) break;
    skipBits(place, 1u);
    uint below = bitsAt(u_material_words, place, 3u);
    skipBits(place, 3u);
    uint len = 1u << below | bitsAt(u_material_words, place, below);
    if (left < len) break;
    left -= len;
    skipBits(place, below);
  }
  return id;
}

bool isLeftOut(ivec3 cell, int level) {
  uint number;
  bool is_stored = findNumber(cell, level, number);
  uint reference = overlayAt(u_material_overlay, cell, level, is_stored);
  if (reference < kOverlayValue && !is_stored) return false;
  uint id = reference < kOverlayValue ? materialOf(number) : reference & ~kOverlayValue;
  return texelFetch(u_hidden_materials, texel(id), 0).x != 0u;
}
