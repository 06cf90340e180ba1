// The DAG in textures: the port of trace/svdag_nodes.hpp.

uniform usampler2D u_nodes;   // r: the words of NODE
uniform usampler2D u_leaves;  // rg: the leaf blocks, lower half first
uniform int u_levels;         // L of the file
uniform int u_shown;          // cells of this level count as voxels; at most L
uniform uint u_root;          // kNoNode: the DAG has no voxels

const uint kNoNode = 0xFFFFFFFFu;
const uint kTexelMask = uint((1 << TEXEL_BITS) - 1);

ivec2 texel(uint i) { return ivec2(int(i & kTexelMask), int(i >> TEXEL_BITS)); }
uint nodeWord(uint i) { return texelFetch(u_nodes, texel(i), 0).x; }
uvec2 leafBlock(uint i) { return texelFetch(u_leaves, texel(i), 0).xy; }

uint bitCount8(uint v) {
  v = v - (v >> 1u & 0x55u);
  v = (v & 0x33u) + (v >> 2u & 0x33u);
  return (v + (v >> 4u)) & 0x0Fu;
}

// Returns a mask whose bit i is set if byte i of the block is not zero.
uint octantsOf(uvec2 block) {
  uvec2 v = block;
  v |= v >> 4u;
  v |= v >> 2u;
  v |= v >> 1u;
  v = ((v & 0x01010101u) * 0x10204080u) >> 28u;
  return v.x | v.y << 4u;
}

uint octantMask(uvec2 block, uint octant) {
  return ((octant & 4u) != 0u ? block.y : block.x) >> (8u * (octant & 3u)) & 0xFFu;
}

// A node is a word index (level < L-2), the index of a leaf block (L-2), or its child mask (L-1).
uint childMask(uint node, int level) {
  if (level < u_levels - DAG_LEAF_LEVELS) return nodeWord(node) & 0xFFu;
  if (level == u_levels - 1) return node;
  return octantsOf(leafBlock(node));
}

uint childOf(uint node, int level, uint index) {
  if (level < u_levels - DAG_LEAF_LEVELS) {
    uint before = nodeWord(node) & ((1u << index) - 1u);
    return nodeWord(node + 1u + bitCount8(before));
  }
  return octantMask(leafBlock(node), index);
}
