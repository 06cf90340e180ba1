#pragma once
/// Keeps the layers around cells, of which smooth normals are fitted.
#include <array>

#include "voxdag/core/lanes.hpp"
#include "voxdag/render/surface_normal.hpp"

namespace voxdag {

/// LayerSums in lanes, to the bit: each lane adds what LayerSums adds, in its order. Cells beyond
/// the radius add zeros, without a branch.
class LayerLanes {
 public:
  void add(std::uint64_t cells, Vec3f base) {
    const FloatLanes first = lanes_of(base);
    for (; cells != 0; cells &= cells - 1) {
      const FloatLanes d = kPlaces[static_cast<std::size_t>(lowest_bit64(cells))] + first;
      const FloatLanes squares = d * d;
      const FloatLanes fall =
          all_lanes(1 - (squares[0] + squares[1] + squares[2]) * LayerRule::kPerRadius2);
      const FloatLanes weighted = d * (fall > all_lanes(0.0f) ? fall * fall : FloatLanes{});
      mean_ += weighted;
      squares_ += weighted * d;
      products_ += __builtin_shufflevector(weighted, weighted, 0, 0, 1, 3) *
                   __builtin_shufflevector(d, d, 1, 2, 2, 3);
    }
  }
  LayerSums total() const {
    return {mean_[3],
            vec_of(mean_),
            {squares_[0], squares_[1], squares_[2], products_[0], products_[1], products_[2]}};
  }

 private:
  /// The places of a block's cells, x, y, z, and 1.
  static constexpr std::array<FloatLanes, 64> kPlaces = [] {
    std::array<FloatLanes, 64> places{};
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Vec3i at = morton_decode(i);
      places[i] = FloatLanes{static_cast<float>(at.x), static_cast<float>(at.y),
                             static_cast<float>(at.z), 1};
    }
    return places;
  }();

  FloatLanes mean_{}, squares_{};  ///< The last lane of `mean_` adds the weights.
  FloatLanes products_{};          ///< xy, xz and yz.
};

/// A table of the layers that one thread found last in one scene. The samples of a tile's pixels
/// show the same cells several times. A cell replaces another one with the same hash.
class LayerCache {
 public:
  /// Returns find_layer(). Calls for one cell must begin with `up` 0, and count up.
  template <class Nodes>
  SurfaceLayer find(const Nodes& nodes, int level, Vec3i cell, int up) {
    Entry& entry = entries_[slot(cell)];
    if (entry.level != level || entry.cell != cell) {
      entry.cell = cell;
      entry.level = level;
      entry.found = 0;
    }
    if (entry.found == up)
      entry.layers[entry.found++] = find_layer<LayerLanes>(nodes, level, cell, up);
    return entry.layers[up];
  }

 private:
  static constexpr int kBits = 10;  // 140 KiB: a part of a core's second-level cache.

  struct Entry {
    Vec3i cell{};
    std::int32_t level = -1;
    std::int32_t found = 0;  ///< The number of `layers` that are known.
    SurfaceLayer layers[1 + LayerRule::kCoarser];
  };

  static std::uint32_t slot(Vec3i cell) {
    const auto part = [](std::int32_t i, std::uint32_t factor) {
      return static_cast<std::uint32_t>(i) * factor;
    };
    return (part(cell.x, 0x9E3779B1u) ^ part(cell.y, 0x85EBCA77u) ^ part(cell.z, 0xC2B2AE3Du)) >>
           (32 - kBits);
  }

  Entry entries_[1 << kBits];
};

}  // namespace voxdag
