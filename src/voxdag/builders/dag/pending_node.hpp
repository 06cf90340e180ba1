#pragma once
/// A node before it has an id.
#include <cstdint>

namespace voxdag {

/// The words of a node that has no id yet. An empty cell has count 0.
struct PendingNode {
  std::uint32_t words[9];
  int count = 0;
  std::uint64_t hash;
};

}  // namespace voxdag
