#pragma once
/// The DAG as packets walk it: beside each pointer, where in the child's cell there are voxels.
#include <cstdint>
#include <memory>

#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// A box in a cell, in 32nds of its side: 30 bits, five each for the first 32nd along x, y and z
/// that has voxels, then for the last one. Rounded outwards where voxels are smaller.
///
/// A surface fills little of the cells that it runs through: rays that pass beside it, or start on
/// it, meet these cells but not their boxes.
struct CellBox {
  static constexpr int kBits = 5;
  static constexpr std::uint32_t kParts = 1u << kBits;

  std::uint32_t bits = 0;
};

/// Made once from a DAG, which it points to: its nodes above the leaf blocks, each at twice its
/// word index there.
///
///   child mask | box of the node | pointer, ... | box of the child, ...      32-bit words
///
/// Pointers are those of the DAG. Copies share all this.
class BoundedDag {
 public:
  /// Uses all threads; O(words) time.
  explicit BoundedDag(const SvdagNodes& nodes);

  const SvdagNodes& nodes() const { return nodes_; }
  int levels() const { return nodes_.levels(); }
  /// Eight words may be read from every box on.
  const std::uint32_t* words() const { return words_.get(); }
  /// What it takes beside the DAG.
  std::uint64_t bytes() const { return word_count() * sizeof(std::uint32_t); }

 private:
  std::uint64_t word_count() const { return nodes_.view().node_words() * 2 + 7; }

  SvdagNodes nodes_;
  std::shared_ptr<std::uint32_t[]> words_;
};

}  // namespace voxdag
