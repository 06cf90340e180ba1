#include "voxdag/stored/compact/compact_parts.hpp"

#include "voxdag/stored/compact/compact_nodes.hpp"

namespace voxdag {
namespace {

/// Returns the bits of the units below a node, as far as they are inline.
std::uint64_t inline_unit_bits(const CompactSvdagView& compact, CompactRange range, int level) {
  if (level == compact.coded_levels() - 4) return range.end - range.begin;
  CompactNode node;
  if (read_node(compact, range, level, node) != CompactFault::kNone) return 0;
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i)
    if ((node.inline_mask >> i & 1) != 0)
      bits += inline_unit_bits(compact, node.children[i], level + 1);
  return bits;
}

}  // namespace

CompactParts compact_parts(const CompactSvdagView& compact) {
  CompactParts parts;
  if (compact.is_empty()) return parts;
  const int brick_level = compact.coded_levels() - 3;
  for (int level = 0; level < brick_level; ++level)
    for (std::uint64_t n = 0; n < compact.shared_nodes(level); ++n)
      parts.unit_bits += inline_unit_bits(compact, shared_node(compact, level, n), level);
  const std::uint64_t bricks = compact.shared_begin[compact.shared_first[brick_level]];
  parts.shared_brick_bits = compact.stream_bits - bricks;
  parts.node_bits = bricks - parts.unit_bits;
  return parts;
}

}  // namespace voxdag
