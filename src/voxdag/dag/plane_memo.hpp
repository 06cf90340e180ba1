#pragma once
/// Remembers the subtrees of cells that one plane crosses and nothing else.
///
/// Such a subtree depends on the plane's normal and on its offset in the cell alone, and for one
/// normal and cell size it is piecewise constant in the offset. An entry is a node and the interval
/// of offsets on which it holds. The memo is a two-way set-associative cache of fixed size, so it
/// bounds the memory that it takes and forgets what a later entry displaces: only time is lost.
#include <bit>
#include <cstdint>

#include "voxdag/dag/node_store.hpp"
#include "voxdag/dag/page_array.hpp"
#include "voxdag/voxelize/triangle_setup.hpp"

namespace voxdag {

/// The subtree of a cell crossed by a slab whose least value, seen from the cell, is `lo`: also
/// that of every slab of the same normal and width with lo - down <= least value <= lo + up.
struct SlabNode {
  NodeId id = kNoNode;
  std::uint64_t down = 0, up = 0;
};

class PlaneMemo {
 public:
  /// Bytes: 128 << log2_sets.
  explicit PlaneMemo(int log2_sets) : sets_(std::size_t{2} << log2_sets) {}

  /// True and the node if the memo has it. `log2_size` is that of the cell in voxels.
  bool find(const PlaneSlab& slab, std::int64_t lo, int log2_size, SlabNode& node) const {
    const Entry* set = set_of(slab, lo, log2_size);
    for (int way = 0; way < 2; ++way) {
      const Entry& e = set[way];
      if (e.log2_size == log2_size && lo >= e.first && lo <= e.last && e.slab_x == slab.normal.x &&
          e.slab_y == slab.normal.y && e.slab_z == slab.normal.z && e.width == slab.width) {
        node = {e.id, static_cast<std::uint64_t>(lo - e.first),
                static_cast<std::uint64_t>(e.last - lo)};
        return true;
      }
    }
    return false;
  }

  void insert(const PlaneSlab& slab, std::int64_t lo, int log2_size, const SlabNode& node) {
    Entry* set = const_cast<Entry*>(set_of(slab, lo, log2_size));
    set[1] = set[0];
    set[0] = {slab.normal.x,
              slab.normal.y,
              slab.normal.z,
              slab.width,
              lo - static_cast<std::int64_t>(node.down),
              lo + static_cast<std::int64_t>(node.up),
              node.id,
              log2_size};
  }

  std::size_t bytes() const { return sets_.bytes(); }

 private:
  struct alignas(64) Entry {
    std::int64_t slab_x, slab_y, slab_z, width;
    std::int64_t first, last;
    NodeId id;
    std::int32_t log2_size;  // 0: free
  };
  static_assert(sizeof(Entry) == 64);

  const Entry* set_of(const PlaneSlab& slab, std::int64_t lo, int log2_size) const {
    // About (2^k)² offsets of a cell of 2^k voxels lie between two breakpoints... of a range of
    // |n|1.
    const std::uint64_t typical = static_cast<std::uint64_t>(slab.width) >> (2 * log2_size);
    const int shift = typical == 0 ? 0 : static_cast<int>(std::bit_width(typical)) - 1;
    std::uint64_t h = static_cast<std::uint64_t>(lo >> shift) * 0x9E3779B97F4A7C15ull;
    h = (h ^ static_cast<std::uint64_t>(slab.normal.x)) * 0xD6E8FEB86659FD93ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(slab.normal.y)) * 0xD6E8FEB86659FD93ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(slab.normal.z)) * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(log2_size)) * 0xD6E8FEB86659FD93ull;
    return sets_.data() + ((h >> 32) & (sets_.size() / 2 - 1)) * 2;
  }

  PageArray<Entry> sets_;
};

}  // namespace voxdag
