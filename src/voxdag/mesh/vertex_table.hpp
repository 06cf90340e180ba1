#pragma once
/// A hash table that gives vertices with equal bits the same index.
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <utility>

#include "voxdag/core/array_store.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

inline std::uint64_t hash_bits(Vec3f position, std::uint64_t seed = 0) {
  const auto key = std::bit_cast<std::array<std::uint32_t, 3>>(position);
  std::uint64_t h = ((key[0] | std::uint64_t{key[1]} << 32) ^ seed) * 0x9E3779B97F4A7C15ull;
  h = (h ^ h >> 32 ^ key[2] ^ seed >> 32) * 0xD6E8FEB86659FD93ull;
  return (h ^ h >> 29) * 0x9E3779B97F4A7C15ull;
}

/// Vertices with distinct bits, numbered in the order in which they were added. The hash has a
/// random seed, so that nobody can construct a file whose vertices collide. The numbers do not
/// depend on the seed.
class VertexTable {
 public:
  /// Makes room for `vertices` vertices and `slots` slots. Both arrays grow when they are full.
  /// They are in `store`; on the heap if it is null.
  explicit VertexTable(std::size_t vertices = 0, std::size_t slots = 64,
                       ArrayStore* store = nullptr)
      : slots_(slots, store), vertices_(store) {
    vertices_.reserve(vertices);
  }

  /// Returns the index of the vertex with the same bits; adds it if there is none.
  std::uint32_t find_or_add(Vec3f position) {
    std::size_t i = hash_slot(position);
    for (; slots_[i] != kFree; i = i + 1 == slots_.size() ? 0 : i + 1)
      if (has_bits(vertices_[std::size_t{slots_[i]} - 1], position)) return slots_[i] - 1;
    const auto vertex = static_cast<std::uint32_t>(vertices_.size());
    slots_[i] = vertex + 1;
    vertices_.push_back(position);
    if (vertices_.size() > slots_.size() / 16 * 15) grow();
    return vertex;
  }

  const StoredVector<Vec3f>& vertices() const { return vertices_; }
  StoredVector<Vec3f> take_vertices() { return std::move(vertices_); }

  /// Returns the most bytes that the table holds while up to `more` vertices are added.
  std::uint64_t bytes_with(std::size_t more) const {
    const std::uint64_t count = vertices_.size() + more;
    const std::uint64_t vertices = vertices_.capacity(), slots = slots_.size();
    // Arrays grow by doubling; the old array exists until the new one is filled.
    return sizeof(Vec3f) * (count <= vertices ? vertices : vertices + 2 * count) +
           sizeof(std::uint32_t) * (count <= slots / 16 * 15 ? slots : slots + 4 * count);
  }

 private:
  static constexpr std::uint32_t kFree = 0;  // New slots are zero, also in a store.

  static bool has_bits(Vec3f a, Vec3f b) {
    using Bits = std::array<std::uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
  }
  std::size_t hash_slot(Vec3f position) const {
    return (hash_bits(position, seed()) >> 32) * slots_.size() >> 32;
  }
  static std::uint64_t seed() {
    static const std::uint64_t value =
        std::random_device()() | std::uint64_t{std::random_device()()} << 32;
    return value;
  }

  void grow() {
    slots_ = StoredVector<std::uint32_t>(2 * slots_.size(), slots_.get_allocator());
    for (std::uint32_t vertex = 0; vertex < vertices_.size(); ++vertex) {
      std::size_t i = hash_slot(vertices_[vertex]);
      while (slots_[i] != kFree) i = i + 1 == slots_.size() ? 0 : i + 1;
      slots_[i] = vertex + 1;
    }
  }

  StoredVector<std::uint32_t> slots_;  ///< A vertex plus 1, or kFree.
  StoredVector<Vec3f> vertices_;
};

}  // namespace voxdag
