#pragma once
/// The DAG for packets: beside each pointer, it stores a box around the voxels in the child's cell.
#include <cstdint>
#include <memory>

#include "voxdag/cpu/packets/bounded_node.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// Built once from a DAG, to which it points. It holds the nodes above the leaf blocks as
/// bounded_node.hpp lays them out. A node's index is twice its word index in the DAG; the pointers
/// are those of the DAG. Copies share the words.
class BoundedDag {
 public:
  /// Builds on all threads in O(words) time.
  explicit BoundedDag(const SvdagNodes& nodes);

  const SvdagNodes& nodes() const { return nodes_; }
  int levels() const { return nodes_.levels(); }
  /// Returns the words. It is safe to read eight words from every box on.
  const std::uint32_t* words() const { return words_.get(); }
  /// Returns the bytes that it takes in addition to the DAG.
  std::uint64_t bytes() const { return word_count() * sizeof(std::uint32_t); }

 private:
  std::uint64_t word_count() const { return nodes_.view().node_words() * 2 + 7; }

  SvdagNodes nodes_;
  std::shared_ptr<std::uint32_t[]> words_;
};

}  // namespace voxdag
