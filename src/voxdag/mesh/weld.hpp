#pragma once
/// Welding of a triangle soup: corners with equal bits become one vertex, in the order in which the
/// soup first has them.
///
/// Memory stays near that of the finished mesh. The triangles' own array first holds, for each
/// corner, the first corner that equals it. To find that, threads split the corners by hash: each
/// scans the whole soup several times, each time with a table for a fraction of the hashes only.
/// Vertices are numbered in place and gathered in a last scan, when their number is known.
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {

/// Maps the bits of a position to the corner that had it first.
class FirstCornerTable {
 public:
  using Key = std::array<std::uint32_t, 3>;

  explicit FirstCornerTable(std::size_t expected) : slots_(expected * 3 / 2 + 16) {}

  static std::uint64_t hash(const Key& key) {
    std::uint64_t h = (key[0] | std::uint64_t{key[1]} << 32) * 0x9E3779B97F4A7C15ull;
    h = (h ^ h >> 32 ^ key[2]) * 0xD6E8FEB86659FD93ull;
    return (h ^ h >> 29) * 0x9E3779B97F4A7C15ull;
  }

  /// The corner that had this key first: `corner` itself if the key is new.
  std::uint32_t find_or_add(const Key& key, std::uint64_t hash, std::uint32_t corner) {
    std::size_t i = home(hash);
    for (; slots_[i].corner != kFree; i = i + 1 == slots_.size() ? 0 : i + 1)
      if (slots_[i].key == key) return slots_[i].corner;
    slots_[i] = {key, corner};
    if (++used_ > slots_.size() / 4 * 3) grow();
    return corner;
  }

 private:
  static constexpr std::uint32_t kFree = ~0u;
  struct Slot {
    Key key{};
    std::uint32_t corner = kFree;
  };

  std::size_t home(std::uint64_t hash) const {
    return static_cast<std::size_t>((hash >> 32) * slots_.size() >> 32);
  }

  void grow() {
    std::vector<Slot> old(slots_.size() + slots_.size() / 2);
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.corner == kFree) continue;
      std::size_t i = home(hash(slot.key));
      while (slots_[i].corner != kFree) i = i + 1 == slots_.size() ? 0 : i + 1;
      slots_[i] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

/// A soup is read in parts: `soup.first_triangles()` tells where each part starts and, last, how
/// many triangles there are, fewer than 2^32 / 3; `soup.visit(part, body)` calls body(Vec3f) for
/// the corners of one part in order, from any thread.
template <class Soup>
Mesh weld(const Soup& soup) {
  Mesh mesh;
  const std::vector<std::size_t>& starts = soup.first_triangles();
  const std::size_t parts = starts.size() - 1;
  mesh.triangles.resize(starts.back());
  if (starts.back() == 0) return mesh;
  std::uint32_t* const corners = mesh.triangles.data()->data();
  const std::size_t corner_count = 3 * starts.back();

  // One table per lane at a time, for a quarter of its hashes where memory is worth more scans.
  constexpr std::size_t kSmall = 300'000;
  const auto lanes =
      static_cast<std::size_t>(std::clamp(tbb::this_task_arena::max_concurrency(), 1, 16));
  const std::size_t shares = corner_count < kSmall ? lanes : 4 * lanes;
  parallel_for(lanes, [&](std::size_t lane) {
    for (std::size_t share = lane; share < shares; share += lanes) {
      FirstCornerTable table(corner_count / 6 / shares * 9 / 8);
      for (std::size_t part = 0; part < parts; ++part) {
        auto corner = static_cast<std::uint32_t>(3 * starts[part]);
        soup.visit(part, [&](Vec3f position) {
          const auto key = std::bit_cast<FirstCornerTable::Key>(position);
          const std::uint64_t hash = FirstCornerTable::hash(key);
          if ((hash & 0xFFFFFFFF) * shares >> 32 == share)
            corners[corner] = table.find_or_add(key, hash, corner);
          ++corner;
        });
      }
    }
  });

  // Number the vertices: a corner that is its own first one is the next vertex.
  std::vector<std::uint32_t> first_vertices(parts);
  std::uint32_t vertices = 0;
  for (std::size_t part = 0, corner = 0; part < parts; ++part) {
    first_vertices[part] = vertices;
    for (; corner < 3 * starts[part + 1]; ++corner)
      corners[corner] = corners[corner] == corner ? vertices++ : corners[corners[corner]];
  }

  mesh.vertices.resize(vertices);
  parallel_for(parts, [&](std::size_t part) {
    std::uint32_t vertex = first_vertices[part];
    const std::uint32_t* corner = corners + 3 * starts[part];
    soup.visit(part, [&](Vec3f position) {
      if (*corner++ == vertex) mesh.vertices[vertex++] = position;
    });
  });
  return mesh;
}

}  // namespace voxdag
