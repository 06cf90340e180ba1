#include "voxdag/voxelize/duplicate_triangles.hpp"

#include <atomic>
#include <bit>
#include <utility>

#include "voxdag/core/int128.hpp"
#include "voxdag/parallel/polled_for.hpp"

namespace voxdag {
namespace {

bool less(const Vec3i& a, const Vec3i& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// A triangle's corners in ascending order, and its look.
struct Key {
  QuantizedTriangle corners;
  std::uint64_t look;
  friend bool operator==(const Key&, const Key&) = default;
};

Key key_of(const QuantizedMesh& mesh, const std::function<std::uint64_t(std::size_t)>& look,
           std::size_t triangle) {
  QuantizedTriangle t = mesh.triangle(triangle);
  if (less(t.y, t.x)) std::swap(t.x, t.y);
  if (less(t.z, t.y)) std::swap(t.y, t.z);
  if (less(t.y, t.x)) std::swap(t.x, t.y);
  return {t, look ? look(triangle) : 0};
}

std::uint64_t hash_of(const Key& key) {
  const auto word = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint32_t>(low) | std::uint64_t{static_cast<std::uint32_t>(high)} << 32;
  };
  const auto [a, b, c] = key.corners;
  std::uint64_t hash = key.look;
  for (const std::uint64_t part :
       {word(a.x, a.y), word(a.z, b.x), word(b.y, b.z), word(c.x, c.y), word(c.z, 0x5bd1e995)}) {
    const Uint128 product =
        static_cast<Uint128>(hash ^ part ^ 0x9E3779B97F4A7C15ull) * 0xD6E8FEB86659FD93ull;
    hash = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }
  return hash;
}

}  // namespace

std::size_t TriangleSet::count() const {
  std::size_t count = 0;
  for (const std::uint64_t word : words_) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

// A table that all threads share, open addressing with linear probing. A slot holds 32 bits of the
// hash, of which the lowest is set, and the lowest index so far of the triangles with its key: of
// two with one key, the one with the higher index is marked. So the marks do not depend on the
// order in which the triangles come.
TriangleSet find_duplicates(const QuantizedMesh& mesh,
                            const std::function<std::uint64_t(std::size_t)>& look,
                            MemoryBudget* budget, Progress* progress) {
  constexpr std::size_t kGrain = 4096;
  const std::size_t count = mesh.triangle_count();
  TriangleSet duplicates(budget);
  duplicates.words_.resize(count / 64 + 1);
  PageVector<std::uint64_t> slots(budget);
  slots.resize(count + count / 2 + 1);
  std::atomic<bool> any{false};
  polled_for(count, kGrain, progress, "quantize", [&](std::size_t i) {
    if (!mesh.in_range(i)) return;
    const Key key = key_of(mesh, look, i);
    const std::uint64_t hash = hash_of(key);
    const std::uint64_t tag = hash << 32 | std::uint64_t{1} << 32;
    std::size_t at = static_cast<std::size_t>((static_cast<Uint128>(hash) * slots.size()) >> 64);
    for (;;) {
      std::atomic_ref slot(slots[at]);
      std::uint64_t seen = slot.load(std::memory_order_relaxed);
      if (seen == 0 && slot.compare_exchange_strong(seen, tag | i, std::memory_order_relaxed))
        return;
      const std::size_t other = seen & 0xFFFFFFFF;
      if ((seen ^ tag) >> 32 != 0 || key_of(mesh, look, other) != key) {
        at = at + 1 < slots.size() ? at + 1 : 0;
        continue;
      }
      if (i < other && !slot.compare_exchange_strong(seen, tag | i, std::memory_order_relaxed))
        continue;
      const std::size_t marked = std::max(i, other);
      std::atomic_ref(duplicates.words_[marked / 64])
          .fetch_or(std::uint64_t{1} << (marked % 64), std::memory_order_relaxed);
      any.store(true, std::memory_order_relaxed);
      return;
    }
  });
  if (!any.load()) duplicates.words_.release();
  return duplicates;
}

}  // namespace voxdag
