#pragma once
/// Grows a context tree from samples.
///
/// Source of the idea: J. Rissanen, "A universal data compression system", IEEE Transactions on
/// Information Theory 1983; the choice between trees by their description length: J. Rissanen,
/// "Modeling by shortest data description", Automatica 1978. The tree grows from one leaf. Each
/// step splits the leaf, by the feature, that saves the most bits, as long as the bits saved exceed
/// those of the larger model. All costs are integers, so that every machine grows the same tree.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/compact/context_tree.hpp"

namespace voxdag {

struct ContextSample {
  std::uint64_t features = 0;
  std::uint32_t symbol = 0;  ///< Below 256.
};

struct TreeLimits {
  int features = 64;         ///< Only the lowest features are used.
  int tables = kMaxTables;   ///< The largest number of leaves.
  std::uint64_t weight = 1;  ///< The number of symbols that a sample stands for.
};

/// Returns a tree without frequencies. Reorders the samples. The result depends on the set of
/// samples alone. Runs on the current TBB arena; throws Cancelled.
ContextTree train_tree(std::span<ContextSample> samples, const TreeLimits& limits, Work work);

}  // namespace voxdag
