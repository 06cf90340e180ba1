#pragma once
/// A compact DAG for the CPU's casters: the nodes above the units are expanded, and a unit is
/// decoded when rays reach it.
///
/// Rays that are near each other reach the same units, so each thread keeps the units that it
/// decoded last. A packet decodes a unit once for all its rays.
#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/cpu/packets/decoded_unit.hpp"
#include "voxdag/layout/compact/compact_svdag.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

class InPlaceDag;

/// The units that one thread decoded last.
class UnitCache {
 public:
  /// `units` is the number of units that the cache holds: a power of two.
  explicit UnitCache(std::size_t units)
      : units_(units), numbers_(units, kNone), bricks_(kBricks), brick_numbers_(kBricks, kNone) {}

  /// Returns a unit of the DAG. The reference is valid until the next call.
  const DecodedUnit& unit(const InPlaceDag& dag, std::uint32_t number) {
    const std::size_t place = number & (units_.size() - 1);
    if (numbers_[place] != number) decode(dag, number, place);
    return units_[place];
  }
  std::uint64_t decoded_units() const { return decoded_units_; }
  std::uint64_t bytes() const;

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  static constexpr std::size_t kBricks = 1 << 12;

  void decode(const InPlaceDag& dag, std::uint32_t number, std::size_t place);
  const DecodedBrick& shared_brick(const CompactSvdagView& compact, std::uint32_t number,
                                   std::uint32_t mask);

  std::vector<DecodedUnit> units_;
  std::vector<std::uint64_t> numbers_;
  std::vector<DecodedBrick> bricks_;
  std::vector<std::uint64_t> brick_numbers_;
  CompactUnit unit_;
  std::uint64_t decoded_units_ = 0;
};

/// Points to the compact DAG, which must outlive it. Copies share their memory.
class InPlaceDag {
 public:
  /// Expands the nodes above the units, and decodes every unit once, for its box, on the threads of
  /// the current TBB arena. The DAG must have four levels or more. `cached_units` is the number of
  /// units that each thread keeps: a power of two. Throws Error if the stream is broken, and
  /// Cancelled; `progress` may be null.
  explicit InPlaceDag(const CompactSvdagView& compact, std::size_t cached_units = kCachedUnits,
                      Progress* progress = nullptr);

  static constexpr std::size_t kCachedUnits = 2048;

  const CompactSvdagView& compact() const { return compact_; }
  bool is_empty() const { return compact_.is_empty(); }
  int levels() const { return compact_.levels; }
  int unit_level() const { return compact_.levels - 4; }
  /// The nodes above the units. See BoundedDag; pointers to units are their numbers.
  const std::uint32_t* words() const { return top_->words.data(); }
  CompactRange unit(std::uint32_t number) const {
    const std::uint64_t packed = top_->units[number];
    return {packed >> kLengthBits, (packed >> kLengthBits) + (packed & kMostLength)};
  }
  /// Returns the cache of the calling thread.
  UnitCache& cache() const { return top_->caches.local(); }

  /// Returns the bytes that it takes in addition to the compact DAG, without the caches.
  std::uint64_t bytes() const;
  /// Returns the bytes of one thread's cache.
  std::uint64_t cache_bytes_per_thread() const { return cache().bytes(); }
  /// Returns how many units all threads decoded so far, after the first time.
  std::uint64_t decoded_units() const;

 private:
  static constexpr int kLengthBits = 24;
  static constexpr std::uint64_t kMostLength = (std::uint64_t{1} << kLengthBits) - 1;

  struct Top {
    explicit Top(std::size_t cached_units) : caches([=] { return UnitCache(cached_units); }) {}

    std::vector<std::uint32_t> words;
    std::vector<std::uint64_t> units;  ///< The first bit << kLengthBits | the number of bits.
    tbb::enumerable_thread_specific<UnitCache> caches;
  };

  CompactSvdagView compact_;
  std::shared_ptr<Top> top_;
};

/// The node layout for single rays (see trace/svdag_nodes.hpp). One thread uses it, with its cache.
/// Nodes below a unit are valid until the cast reaches another unit.
class InPlaceNodes {
 public:
  using Node = std::uint32_t;

  InPlaceNodes(const InPlaceDag& dag, UnitCache& cache)
      : dag_(&dag),
        cache_(&cache),
        words_(dag.words()),
        levels_(dag.levels()),
        unit_level_(dag.unit_level()) {}

  bool is_empty() const { return dag_->is_empty(); }
  int levels() const { return levels_; }
  Node root() const { return 0; }

  std::uint32_t child_mask(Node node, int level) const {
    const int below = level - unit_level_;
    if (below < 0) return words_[2 * std::size_t{node}];
    if (below == 0) {
      unit_ = &cache_->unit(*dag_, node);
      return unit_->words[0];
    }
    if (below == 1) return unit_->words[2 * node];
    if (below == 2) return leaf_block_child_mask(unit_->leaf_blocks[node]);
    return node;
  }
  Node child(Node node, int level, int index) const {
    const int below = level - unit_level_;
    if (below < 0) return child_of(words_ + 2 * std::size_t{node}, index);
    if (below == 0) {
      unit_ = &cache_->unit(*dag_, node);
      return child_of(unit_->words, index);
    }
    if (below == 1) return child_of(unit_->words + 2 * node, index);
    return static_cast<Node>(unit_->leaf_blocks[node] >> (8 * index) & 0xFFu);
  }

 private:
  static Node child_of(const std::uint32_t* node, int index) {
    return node[2 + popcount8(node[0] & ((1u << index) - 1))];
  }

  const InPlaceDag* dag_;
  UnitCache* cache_;
  const std::uint32_t* words_;
  int levels_, unit_level_;
  mutable const DecodedUnit* unit_ = nullptr;  ///< The unit that the walk reached last.
};

}  // namespace voxdag
