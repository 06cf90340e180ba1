#pragma once
/// Reads the nodes of a compact DAG.
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/compact/unit_cells.hpp"

namespace voxdag {

/// The bits of a node and of all that stands inline below it.
struct CompactRange {
  std::uint64_t begin = 0, end = 0;
};

/// A node above the units.
struct CompactNode {
  std::uint8_t mask = 0;
  std::uint8_t inline_mask = 0;  ///< Which of the children are inline.
  std::uint32_t shared[8] = {};  ///< The numbers of the others among the shared nodes.
  CompactRange children[8];
};

/// A unit. Its bricks are leaf masks, in the order of the octants.
struct CompactUnit {
  std::uint8_t mask = 0;
  std::uint8_t inline_mask = 0;  ///< Which of the bricks are in `bricks`.
  std::uint8_t brick_masks[8] = {};
  std::uint32_t shared[8] = {};  ///< The numbers of the others among the shared bricks.
  std::uint64_t bricks[8][8] = {};
};

/// The faults of a broken stream. Readers may ignore them: what they return is safe to use.
enum class CompactFault { kNone, kMask, kNumber, kLength, kEnd };

/// Returns the bits of shared node `number` of `level`.
VOXDAG_HD inline CompactRange shared_node(const CompactSvdagView& dag, int level,
                                          std::uint64_t number) {
  const std::uint64_t* begin = dag.shared_begin + dag.shared_first[level] + number;
  return {begin[0], begin[1]};
}

VOXDAG_HD inline CompactRange root_node(const CompactSvdagView& dag) {
  return shared_node(dag, 0, 0);
}

namespace detail {

/// Reads the bits behind an open record.
class TailReader {
 public:
  VOXDAG_HD TailReader(const std::uint32_t* words, std::uint64_t begin, std::uint64_t end)
      : words_(words), at_(begin < end ? begin : end), end_(end), is_past_end_(begin > end) {}

  /// Reads a number of `bits` bits, 0 to 63. Returns 0 if fewer bits are left.
  VOXDAG_HD std::uint64_t read(int bits) {
    if (end_ - at_ < static_cast<std::uint64_t>(bits)) {
      is_past_end_ = true;
      return 0;
    }
    const int high = bits > 32 ? bits - 32 : 0;
    const std::uint64_t value = static_cast<std::uint64_t>(read_bits(words_, at_, high))
                                    << (bits - high) |
                                read_bits(words_, at_ + static_cast<unsigned>(high), bits - high);
    at_ += static_cast<unsigned>(bits);
    return value;
  }
  VOXDAG_HD std::uint64_t position() const { return at_; }
  VOXDAG_HD bool is_past_end() const { return is_past_end_; }

 private:
  const std::uint32_t* words_;
  std::uint64_t at_, end_;
  bool is_past_end_;
};

}  // namespace detail

namespace detail {

/// Reads the leaves of a brick. Returns false if a mask was zero.
VOXDAG_HD inline bool read_brick(const CompactSvdagView& dag, SymbolReader& reader, int octant,
                                 std::uint32_t mask, UnitCells& cells, std::uint64_t (&leaves)[8]) {
  return cells.visit_brick(
      octant, mask, leaves,
      [&](std::uint64_t features, std::uint32_t& leaf) {
        leaf = dag.trees[kLeafMask].read(reader, features);
      },
      [&](std::uint64_t features, std::uint32_t& cell) {
        cell = dag.trees[kCellMask].read(reader, features);
      });
}

}  // namespace detail

/// Reads a node of `level` < C-4. Any bits are safe to read; the ranges of the children lie within
/// the stream in any case.
VOXDAG_HD inline CompactFault read_node(const CompactSvdagView& dag, CompactRange range, int level,
                                        CompactNode& node) {
  const int coded_levels = dag.coded_levels();
  SymbolReader reader(dag.stream, range.begin, range.end);
  std::uint8_t kinds[8], unit_bits[8] = {};
  const std::uint32_t node_class = level_class(level, coded_levels);
  const std::uint32_t mask = dag.trees[kNodeMask].read(reader, node_class);
  for (int i = 0; i < 8; ++i) {
    kinds[i] = 0;
    if ((mask >> i & 1u) != 0)
      kinds[i] = static_cast<std::uint8_t>(
          dag.trees[kChildKind].read(reader, kind_features(mask, i, kinds, node_class, 0)));
  }
  node.mask = static_cast<std::uint8_t>(mask);
  node.inline_mask = 0;
  int inline_left = 0;
  for (int i = 0; i < 8; ++i) {
    if ((mask >> i & 1u) == 0 || kinds[i] != 0) continue;
    node.inline_mask = static_cast<std::uint8_t>(node.inline_mask | 1u << i);
    ++inline_left;
  }
  const bool above_units = level + 1 == coded_levels - 4;
  int left = inline_left;
  for (int i = 0; i < 8 && left > 1 && above_units; ++i) {
    if ((node.inline_mask >> i & 1u) == 0) continue;
    unit_bits[i] =
        static_cast<std::uint8_t>(dag.trees[kUnitBits].read(reader, unit_features(mask, i, left)));
    --left;
  }
  CompactFault fault = mask == 0 ? CompactFault::kMask : CompactFault::kNone;

  detail::TailReader tail(dag.stream, reader.open_end(), range.end);
  std::uint64_t lengths[8] = {};
  left = inline_left;
  for (int i = 0; i < 8; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    if (kinds[i] != 0) {
      std::uint64_t number = (std::uint64_t{1} << (kinds[i] - 1) | tail.read(kinds[i] - 1)) - 1;
      if (number >= dag.shared_nodes(level + 1)) {
        fault = CompactFault::kNumber;
        number = 0;
        if (dag.shared_nodes(level + 1) == 0) {
          node.children[i] = {range.end, range.end};
          continue;
        }
      }
      node.shared[i] = static_cast<std::uint32_t>(number);
      node.children[i] = shared_node(dag, level + 1, number);
    } else if (left-- > 1) {
      const int bits = above_units ? unit_bits[i] : static_cast<int>(tail.read(6));
      if (bits != 0) lengths[i] = std::uint64_t{1} << (bits - 1) | tail.read(bits - 1);
    }
  }
  if (tail.is_past_end()) fault = CompactFault::kEnd;

  std::uint64_t at = tail.position();
  left = inline_left;
  for (int i = 0; i < 8; ++i) {
    if ((node.inline_mask >> i & 1u) == 0) continue;
    std::uint64_t end = range.end;
    if (left-- > 1) {
      if (lengths[i] > range.end - at)
        fault = CompactFault::kLength;
      else
        end = at + lengths[i];
    }
    node.children[i] = {at, end};
    at = end;
  }
  return fault;
}

/// Reads a unit. Any bits are safe to read.
VOXDAG_HD inline CompactFault read_unit(const CompactSvdagView& dag, CompactRange range,
                                        CompactUnit& unit) {
  SymbolReader reader(dag.stream, range.begin, range.end);
  const std::uint32_t mask = dag.trees[kNodeMask].read(reader, 0);
  unit.mask = static_cast<std::uint8_t>(mask);
  unit.inline_mask = 0;
  CompactFault fault = mask == 0 ? CompactFault::kMask : CompactFault::kNone;
  UnitCells cells(mask);
  std::uint8_t kinds[8];
  for (int i = 0; i < 8; ++i) {
    kinds[i] = 0;
    unit.brick_masks[i] = 0;
    if ((mask >> i & 1u) == 0) continue;
    const std::uint32_t brick = dag.trees[kBrickMask].read(reader, cells.brick_features(i));
    if (brick == 0) fault = CompactFault::kMask;
    cells.set_brick(i, brick);
    unit.brick_masks[i] = static_cast<std::uint8_t>(brick);
    kinds[i] = static_cast<std::uint8_t>(
        dag.trees[kChildKind].read(reader, kind_features(mask, i, kinds, 0, brick)));
    if (kinds[i] == 0) {
      unit.inline_mask = static_cast<std::uint8_t>(unit.inline_mask | 1u << i);
      continue;
    }
    const int bits = kinds[i] - 1;
    const std::uint64_t number =
        dag.brick_first[brick] + (std::uint64_t{1} << bits | reader.take_raw(bits)) - 1;
    unit.shared[i] = static_cast<std::uint32_t>(number);
    if (number < dag.brick_first[brick + 1]) continue;
    fault = CompactFault::kNumber;
    unit.shared[i] = 0;
  }
  for (int i = 0; i < 8; ++i) {
    for (std::uint64_t& leaf : unit.bricks[i]) leaf = 0;
    if ((unit.inline_mask >> i & 1u) != 0 &&
        !detail::read_brick(dag, reader, i, unit.brick_masks[i], cells, unit.bricks[i]))
      fault = CompactFault::kMask;
  }
  if (!reader.is_finished() && fault == CompactFault::kNone) fault = CompactFault::kEnd;
  return fault;
}

/// Reads the shared brick that has these bits and this mask. Any bits are safe to read.
VOXDAG_HD inline CompactFault read_shared_brick(const CompactSvdagView& dag, CompactRange range,
                                                std::uint32_t mask, std::uint64_t (&leaves)[8]) {
  SymbolReader reader(dag.stream, range.begin, range.end);
  UnitCells cells(0);
  cells.set_brick(0, mask);
  for (std::uint64_t& leaf : leaves) leaf = 0;
  if (!detail::read_brick(dag, reader, 0, mask, cells, leaves)) return CompactFault::kMask;
  return reader.is_finished() ? CompactFault::kNone : CompactFault::kEnd;
}

}  // namespace voxdag
