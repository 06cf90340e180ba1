#pragma once
/// A compact DAG for the CPU's casters: the nodes above the units are expanded, and a unit is
/// decoded when rays reach it.
///
/// Rays that are near each other reach the same units, so each thread keeps the units that it
/// decoded last. A packet decodes a unit once for all its rays.

#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/packets/unit_cache.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

/// Points to the compact DAG, which must outlive it. Copies share their memory.
class InPlaceDag {
 public:
  /// Expands the nodes above the units, and decodes every unit once, for its box, on the threads of
  /// the current TBB arena. The DAG must have four levels or more. `cached_units` is the number of
  /// units that each thread keeps: a power of two. Throws Error if the stream is broken, and
  /// Cancelled.
  explicit InPlaceDag(const CompactSvdagView& compact, std::size_t cached_units = kCachedUnits,
                      Work work = {});

  static constexpr std::size_t kCachedUnits = 2048;  ///< The default of `cached_units`.

  const CompactSvdagView& compact() const { return compact_; }
  bool is_empty() const { return compact_.is_empty(); }
  int levels() const { return compact_.levels; }
  int unit_level() const { return compact_.levels - 4; }
  /// Returns the nodes above the units, as bounded_node.hpp lays them out. A node's index is half
  /// its word index; a pointer to a unit is the unit's number. Eight words are safe to read from
  /// every box on.
  const std::uint32_t* words() const { return top_->words.data(); }
  /// Returns the bits of a unit.
  CompactRange unit(std::uint32_t number) const {
    const std::uint64_t packed = top_->units[number];
    return {packed >> kLengthBits, (packed >> kLengthBits) + (packed & kMaxLength)};
  }
  /// Returns the cache of the calling thread.
  UnitCache& cache() const { return top_->caches.local(); }

  /// Returns the bytes of this object beyond the compact DAG, without the caches.
  std::uint64_t bytes() const;
  /// Returns the bytes of one thread's cache.
  std::uint64_t cache_bytes_per_thread() const { return cache().bytes(); }
  /// Returns how many units the caches of all threads decoded so far.
  std::uint64_t decoded_units() const;

 private:
  static constexpr int kLengthBits = 24;
  static constexpr std::uint64_t kMaxLength = (std::uint64_t{1} << kLengthBits) - 1;

  struct Top {
    explicit Top(std::size_t cached_units) : caches([=] { return UnitCache(cached_units); }) {}

    std::vector<std::uint32_t> words;
    std::vector<std::uint64_t>
        units;  ///< For each unit: first bit << kLengthBits | number of bits.
    PerThread<UnitCache> caches;
  };

  CompactSvdagView compact_;
  std::shared_ptr<Top> top_;
};

}  // namespace voxdag
