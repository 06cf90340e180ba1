#pragma once
/// Divides the nodes of a DAG into inline and shared ones, as the compact form stores them, and
/// numbers both.
#include <cstdint>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The numbers of a DAG's nodes. The DAG must outlive this object; it has four levels or more, and
/// voxels.
class NumberedNodes {
 public:
  /// Counts the pointers to each node. O(DAG) time; 4 bytes of memory per word of the DAG and 4 per
  /// node. Throws OverMemory and Cancelled.
  NumberedNodes(const SvdagView& dag, Work work);

  const SvdagView& dag() const { return dag_; }
  int unit_level() const { return dag_.levels - 4; }
  int brick_level() const { return dag_.levels - 3; }

  /// The first words of the nodes of a level 0 to C-4, in their order.
  const std::vector<std::uint32_t>& nodes(int level) const { return nodes_[index(level)]; }
  /// The shared nodes of a level 0 to C-3, in the order of their numbers. A node is its position in
  /// nodes(level), a brick its first word.
  const std::vector<std::uint32_t>& shared(int level) const { return shared_[index(level)]; }

  /// The shared bricks with mask m have the numbers [m] to [m + 1] - 1.
  const std::vector<std::uint64_t>& brick_first() const { return brick_first_; }

  /// Returns whether the node of level >= 1 at this word is shared.
  bool is_shared(std::uint32_t word) const { return (tags_[word] & kShared) != 0; }
  /// Returns the number of a shared node among the shared ones of its level.
  std::uint32_t shared_number(std::uint32_t word) const { return tags_[word] & ~kShared; }
  /// Returns the position in nodes() of an inline node of a level above the bricks.
  std::uint32_t position(std::uint32_t word) const { return tags_[word]; }

 private:
  static constexpr std::uint32_t kShared = 0x80000000u;
  static std::size_t index(int level) { return static_cast<std::size_t>(level); }

  SvdagView dag_;
  CountedVector<std::uint32_t> tags_;  ///< Of the first word of each node.
  std::vector<std::vector<std::uint32_t>> nodes_, shared_;
  std::vector<std::uint64_t> brick_first_ = std::vector<std::uint64_t>(257);
  MemoryReservation lists_;
};

}  // namespace voxdag
