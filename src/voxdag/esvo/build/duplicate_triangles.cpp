#include "voxdag/esvo/build/duplicate_triangles.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>

#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// All that distinguishes a corner, as words of bits.
using CornerWords = std::array<std::uint32_t, 10>;

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 29;
}

class TriangleKeys {
 public:
  TriangleKeys(const Mesh& mesh, const Appearance* appearance)
      : mesh_(mesh), appearance_(appearance) {}

  /// Returns a hash that is equal for equal triangles, whichever corner comes first.
  std::uint64_t hash(std::size_t triangle) const {
    std::array<std::uint64_t, 3> h{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (const std::uint32_t word : words(triangle, corner)) h[corner] = mix(h[corner], word);
    std::rotate(h.begin(), std::min_element(h.begin(), h.end()), h.end());
    return mix(mix(mix(material(triangle), h[0]), h[1]), h[2]);
  }

  bool are_equal(std::size_t a, std::size_t b) const {
    if (material(a) != material(b)) return false;
    for (std::size_t first = 0; first < 3; ++first)
      if (words(a, 0) == words(b, first) && words(a, 1) == words(b, (first + 1) % 3) &&
          words(a, 2) == words(b, (first + 2) % 3))
        return true;
    return false;
  }

 private:
  std::uint32_t material(std::size_t triangle) const {
    return appearance_ == nullptr ? 0 : Appearance::material_index(mesh_, triangle);
  }

  CornerWords words(std::size_t triangle, std::size_t corner) const {
    CornerWords words{};
    std::size_t count = 0;
    const auto add = [&](float value) {
      words[count++] = std::bit_cast<std::uint32_t>(value + 0.0f);  // -0 becomes 0.
    };
    const Vec3f& p = mesh_.vertices[mesh_.triangles[triangle][corner]];
    for (const float value : {p.x, p.y, p.z}) add(value);
    if (appearance_ == nullptr) return words;
    const std::size_t at = 3 * triangle + corner;
    if (!appearance_->normals.empty()) {
      const Vec3f& n = appearance_->normals[at];
      for (const float value : {n.x, n.y, n.z}) add(value);
    }
    if (!appearance_->uvs.empty()) {
      add(appearance_->uvs[at].x);
      add(appearance_->uvs[at].y);
    }
    if (!appearance_->colors.empty()) {
      const Rgba16& c = appearance_->colors[at];
      words[count++] = std::uint32_t{c.r} << 16 | c.g;
      words[count++] = std::uint32_t{c.b} << 16 | c.a;
    }
    return words;
  }

  const Mesh& mesh_;
  const Appearance* appearance_;
};

}  // namespace

std::vector<std::uint8_t> find_duplicate_triangles(const Mesh& mesh, const Appearance* appearance,
                                                   Progress* progress, MemoryBudget* memory) {
  const TriangleKeys keys(mesh, appearance);
  const std::size_t count = mesh.triangles.size();
  constexpr std::uint64_t kIndex = 0xFFFFFFFF;
  // The upper half of a triangle's hash and its index.
  CountedVector<std::uint64_t> order(count, memory);
  parallel_for(count, 1024, [&](std::size_t i) { order[i] = (keys.hash(i) & ~kIndex) | i; });
  if (progress != nullptr) progress->throw_if_cancelled();
  tbb::parallel_sort(order.begin(), order.end());
  std::vector<std::uint8_t> duplicates;
  std::size_t first = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (i % (1 << 20) == 0 && progress != nullptr) progress->throw_if_cancelled();
    // Compares each triangle with the first of its hash: by chance this may miss a duplicate.
    if (order[i] >> 32 != order[first] >> 32 ||
        !keys.are_equal(order[first] & kIndex, order[i] & kIndex)) {
      first = i;
      continue;
    }
    if (duplicates.empty()) duplicates.resize(count);
    duplicates[order[i] & kIndex] = 1;
  }
  return duplicates;
}

}  // namespace voxdag
