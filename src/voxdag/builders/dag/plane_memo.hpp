#pragma once
/// Caches the subtrees of cells that contain one plane and nothing else.
///
/// Such a subtree depends only on the plane's normal and its offset in the cell. For one normal and
/// cell size it is piecewise constant in the offset. An entry is a node and the interval of offsets
/// for which it is correct. The memo is a two-way set-associative cache of fixed size: a new entry
/// may evict an old one, which costs time but never changes the result.
#include <bit>
#include <cstdint>

#include "voxdag/builders/dag/node_store.hpp"
#include "voxdag/builders/voxelize/triangle_setup.hpp"

namespace voxdag {

/// The subtree of a cell that contains a slab whose least value, relative to the cell, is `lo`. It
/// is valid for every slab of that normal and width with lo - down <= least value <= lo + up.
struct SlabNode {
  NodeId id = kNoNode;
  std::uint64_t down = 0, up = 0;
};

class PlaneMemo {
 public:
  explicit PlaneMemo(int log2_sets)
      : sets_(PageVector<Entry>::zeros(std::size_t{2} << log2_sets)) {}

  /// Returns true and sets `node` if the memo has it. The cell has 2^log2_size voxels a side.
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

  static constexpr std::uint64_t bytes(int log2_sets) { return 2 * sizeof(Entry) << log2_sets; }

 private:
  struct alignas(64) Entry {
    std::int64_t slab_x, slab_y, slab_z, width;
    std::int64_t first, last;
    NodeId id;
    std::int32_t log2_size;  // 0: free
  };
  static_assert(sizeof(Entry) == 64);

  const Entry* set_of(const PlaneSlab& slab, std::int64_t lo, int log2_size) const {
    // The offsets of a cell of 2^k voxels span about |n|1 * 2^k, with up to (2^k)³ breakpoints, so
    // about |n|1 / (2^k)² offsets lie between two of them.
    const std::uint64_t typical = static_cast<std::uint64_t>(slab.width) >> (2 * log2_size);
    const int shift = typical == 0 ? 0 : static_cast<int>(std::bit_width(typical)) - 1;
    std::uint64_t h = static_cast<std::uint64_t>(lo >> shift) * 0x9E3779B97F4A7C15ull;
    h = (h ^ static_cast<std::uint64_t>(slab.normal.x)) * 0xD6E8FEB86659FD93ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(slab.normal.y)) * 0xD6E8FEB86659FD93ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(slab.normal.z)) * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(log2_size)) * 0xD6E8FEB86659FD93ull;
    return sets_.data() + ((h >> 32) & (sets_.size() / 2 - 1)) * 2;
  }

  PageVector<Entry> sets_;
};

}  // namespace voxdag
