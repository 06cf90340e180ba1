#include "voxdag/compact/coarsen.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "voxdag/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// The different nodes of one level, in the order in which they are added. A node is its words; a
/// leaf block is two words.
class UniqueNodes {
 public:
  explicit UniqueNodes(MemoryBudget* memory) : words_(memory), slots_(64, kFree, memory) {}

  /// Returns the first word of the node, which is added if it is new.
  std::uint32_t add(const std::uint32_t* node, std::size_t size) {
    if ((nodes_ + 1) * 2 > slots_.size()) grow();
    std::size_t slot = hash(node, size) & (slots_.size() - 1);
    for (; slots_[slot] != kFree; slot = (slot + 1) & (slots_.size() - 1))
      if (std::equal(node, node + size, words_.data() + slots_[slot],
                     words_.data() + std::min(words_.size(), slots_[slot] + size)))
        return slots_[slot];
    const auto place = static_cast<std::uint32_t>(words_.size());
    slots_[slot] = place;
    words_.insert(words_.end(), node, node + size);
    starts_.push_back(place);
    ++nodes_;
    return place;
  }
  const CountedVector<std::uint32_t>& words() const { return words_; }

 private:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  static std::size_t hash(const std::uint32_t* words, std::size_t size) {
    std::uint64_t h = size;
    for (std::size_t i = 0; i < size; ++i) {
      h = (h ^ words[i]) * 0x9E3779B97F4A7C15ull;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h ^ h >> 32);
  }
  void grow() {
    CountedVector<std::uint32_t> wider(slots_.size() * 2, kFree, slots_.get_allocator());
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      const std::size_t end = i + 1 < starts_.size() ? starts_[i + 1] : words_.size();
      std::size_t slot = hash(words_.data() + starts_[i], end - starts_[i]) & (wider.size() - 1);
      while (wider[slot] != kFree) slot = (slot + 1) & (wider.size() - 1);
      wider[slot] = starts_[i];
    }
    slots_.swap(wider);
  }

  CountedVector<std::uint32_t> words_, slots_;
  std::vector<std::uint32_t> starts_;
  std::uint64_t nodes_ = 0;
};

/// Returns the child mask of the node of `level` < L at `pointer`.
std::uint32_t mask_of(const SvdagView& dag, int level, std::uint32_t pointer) {
  return level == dag.levels - 2 ? leaf_block_child_mask(dag.leaf_blocks[pointer])
                                 : child_mask(dag.nodes + pointer);
}

/// Returns the mask of the 4³ cells two levels below a node of a level up to L-3.
std::uint64_t block_of(const SvdagView& dag, int level, const std::uint32_t* node) {
  std::uint64_t block = 0;
  for (int i = 0; i < 8; ++i)
    if ((child_mask(node) >> i & 1u) != 0)
      block |= static_cast<std::uint64_t>(mask_of(dag, level + 1, child_pointer(node, i)))
               << (8 * i);
  return block;
}

}  // namespace

Svdag coarsen(const SvdagView& dag, int levels, MemoryBudget* memory, Progress* progress) {
  assert(levels >= kMinLevels && levels <= dag.levels);
  Svdag coarse;
  coarse.levels = levels;
  if (dag.is_empty()) return coarse;
  if (levels == dag.levels) {
    coarse.nodes.assign(dag.nodes, dag.nodes + dag.node_words());
    coarse.leaf_blocks.assign(dag.leaf_blocks, dag.leaf_blocks + dag.leaf_block_count);
    std::copy(std::begin(dag.level_begin), std::end(dag.level_begin), coarse.level_begin.begin());
    return coarse;
  }
  // Old nodes of a level come in canonical order, which is that of their least Morton paths. So the
  // new nodes, each first met at its least old one, are in canonical order too.
  std::vector<UniqueNodes> unique;
  for (int level = 0; level <= levels - 2; ++level) unique.emplace_back(memory);
  CountedVector<std::uint32_t> places(memory), places_below(memory);
  for (int level = levels - 2; level >= 0; --level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    places.assign(end - begin, 0);
    UniqueNodes& nodes = unique[static_cast<std::size_t>(level)];
    for (std::uint64_t at = begin; at < end;) {
      poll_seldom(progress, at);
      const std::uint32_t* node = dag.nodes + at;
      const auto children = static_cast<std::size_t>(popcount(node[0]));
      std::array<std::uint32_t, 9> words;
      std::size_t size = 1 + children;
      if (level == levels - 2) {
        const std::uint64_t block = block_of(dag, level, node);
        words[0] = static_cast<std::uint32_t>(block);
        words[1] = static_cast<std::uint32_t>(block >> 32);
        size = 2;
      } else {
        words[0] = node[0];
        for (std::size_t i = 1; i <= children; ++i)
          words[i] = places_below[node[i] - dag.level_begin[level + 1]];
      }
      places[at - begin] = nodes.add(words.data(), size);
      at += 1 + children;
    }
    places.swap(places_below);
  }

  for (int level = 0; level < levels - 2; ++level) {
    const auto& words = unique[static_cast<std::size_t>(level)].words();
    coarse.level_begin[static_cast<std::size_t>(level)] = coarse.nodes.size();
    const auto next = static_cast<std::uint32_t>(coarse.nodes.size() + words.size());
    for (std::size_t i = 0; i < words.size();) {
      coarse.nodes.push_back(words[i]);
      for (int left = popcount(words[i++]); left > 0; --left, ++i)
        coarse.nodes.push_back(level == levels - 3 ? words[i] / 2 : next + words[i]);
    }
  }
  for (int level = levels - 2; level <= kMaxLevels; ++level)
    coarse.level_begin[static_cast<std::size_t>(level)] = coarse.nodes.size();
  const auto& leaves = unique.back().words();
  for (std::size_t i = 0; i < leaves.size(); i += 2)
    coarse.leaf_blocks.push_back(leaves[i] | static_cast<std::uint64_t>(leaves[i + 1]) << 32);
  return coarse;
}

}  // namespace voxdag
