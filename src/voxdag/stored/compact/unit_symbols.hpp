#pragma once
/// Visits the symbols of a DAG's nodes in the order of the compact form.
///
/// A sink has
///   symbol(CompactSymbol, features, value)
///   raw(value, bits)       a number of `bits` bits
#include <bit>
#include <cstdint>

#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/compact/numbered_nodes.hpp"
#include "voxdag/stored/compact/unit_cells.hpp"

namespace voxdag {

/// Returns the kind of the child at `pointer`; the number of a shared brick is counted from
/// `first`.
inline std::uint8_t child_kind(const NumberedNodes& nodes, std::uint32_t pointer,
                               std::uint64_t first) {
  if (!nodes.is_shared(pointer)) return 0;
  return static_cast<std::uint8_t>(std::bit_width(nodes.shared_number(pointer) - first + 1));
}

/// Visits the mask of a node above the units and the kinds of its children. `kinds` gets the kinds,
/// 0 where there is no child.
template <class Sink>
void visit_node(const NumberedNodes& nodes, std::uint32_t word, int level, Sink& sink,
                std::uint8_t (&kinds)[8]) {
  const SvdagView& dag = nodes.dag();
  const std::uint32_t node_class = level_class(level, dag.levels);
  const std::uint32_t mask = child_mask(dag.nodes + word);
  sink.symbol(kNodeMask, node_class, mask);
  for (int i = 0; i < 8; ++i) {
    kinds[i] = 0;
    if ((mask >> i & 1u) == 0) continue;
    const std::uint8_t kind = child_kind(nodes, child_pointer(dag.nodes + word, i), 0);
    sink.symbol(kChildKind, kind_features(mask, i, kinds, node_class, 0), kind);
    kinds[i] = kind;
  }
}

namespace detail {

template <class Sink>
void visit_leaves(const SvdagView& dag, std::uint32_t brick, int octant, UnitCells& cells,
                  Sink& sink) {
  const std::uint32_t mask = child_mask(dag.nodes + brick);
  std::uint64_t leaves[8] = {};
  for (int q = 0; q < 8; ++q)
    if ((mask >> q & 1u) != 0) leaves[q] = dag.leaf_blocks[child_pointer(dag.nodes + brick, q)];
  cells.visit_brick(
      octant, mask, leaves,
      [&](std::uint64_t features, std::uint32_t leaf) { sink.symbol(kLeafMask, features, leaf); },
      [&](std::uint64_t features, std::uint32_t cell) { sink.symbol(kCellMask, features, cell); });
}

}  // namespace detail

/// Visits all symbols of the unit at this word.
template <class Sink>
void visit_unit(const NumberedNodes& nodes, std::uint32_t word, Sink& sink) {
  const SvdagView& dag = nodes.dag();
  const std::uint32_t* unit = dag.nodes + word;
  const std::uint32_t mask = child_mask(unit);
  sink.symbol(kNodeMask, 0, mask);
  UnitCells cells(mask);
  std::uint8_t kinds[8];
  for (int i = 0; i < 8; ++i) {
    kinds[i] = 0;
    if ((mask >> i & 1u) == 0) continue;
    const std::uint32_t pointer = child_pointer(unit, i);
    const std::uint32_t brick = child_mask(dag.nodes + pointer);
    sink.symbol(kBrickMask, cells.brick_features(i), brick);
    cells.set_brick(i, brick);
    const std::uint8_t kind = child_kind(nodes, pointer, nodes.brick_first()[brick]);
    sink.symbol(kChildKind, kind_features(mask, i, kinds, 0, brick), kind);
    kinds[i] = kind;
    if (kind == 0) continue;
    const auto number =
        static_cast<std::uint32_t>(nodes.shared_number(pointer) - nodes.brick_first()[brick] + 1);
    sink.raw(number ^ 1u << (kind - 1), kind - 1);
  }
  for (int i = 0; i < 8; ++i)
    if ((mask >> i & 1u) != 0 && kinds[i] == 0)
      detail::visit_leaves(dag, child_pointer(unit, i), i, cells, sink);
}

/// Visits all symbols of the shared brick at this word.
template <class Sink>
void visit_shared_brick(const NumberedNodes& nodes, std::uint32_t word, Sink& sink) {
  UnitCells cells(0);
  cells.set_brick(0, child_mask(nodes.dag().nodes + word));
  detail::visit_leaves(nodes.dag(), word, 0, cells, sink);
}

}  // namespace voxdag
