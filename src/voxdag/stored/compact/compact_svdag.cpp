#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

CompactSvdagView CompactSvdag::view() const {
  CompactSvdagView v;
  v.stream = stream.data();
  v.stream_bits = stream_bits;
  v.shared_begin = shared_begin.data();
  v.brick_first = brick_first.data();
  v.levels = levels;
  std::uint64_t first = 0;
  for (int level = 0; level <= kMaxLevels; ++level) {
    v.shared_first[level] = first;
    if (static_cast<std::size_t>(level) < shared_counts.size())
      first += shared_counts[static_cast<std::size_t>(level)];
  }
  for (int i = 0; i < kCompactSymbols; ++i) v.trees[i] = trees[i].view();
  return v;
}

}  // namespace voxdag
