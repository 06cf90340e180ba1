#include "voxdag/builders/voxelize/duplicate_triangles.hpp"

#include <utility>

namespace voxdag {
namespace {

class TriangleCorners {
 public:
  explicit TriangleCorners(const QuantizedMesh& mesh) : mesh_(mesh) {}

  std::optional<std::uint64_t> hash(std::size_t triangle) const {
    if (!mesh_.in_range(triangle)) return std::nullopt;
    const auto word = [](std::int32_t low, std::int32_t high) {
      return static_cast<std::uint32_t>(low) | std::uint64_t{static_cast<std::uint32_t>(high)}
                                                   << 32;
    };
    const auto [a, b, c] = sorted(triangle);
    std::uint64_t hash = 0;
    for (const std::uint64_t part :
         {word(a.x, a.y), word(a.z, b.x), word(b.y, b.z), word(c.x, c.y), word(c.z, 0x5bd1e995)}) {
      const Uint128 product =
          static_cast<Uint128>(hash ^ part ^ 0x9E3779B97F4A7C15ull) * 0xD6E8FEB86659FD93ull;
      hash = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
    }
    return hash;
  }
  bool are_equal(std::size_t a, std::size_t b) const { return sorted(a) == sorted(b); }

 private:
  /// Returns the corners in ascending order.
  QuantizedTriangle sorted(std::size_t triangle) const {
    QuantizedTriangle t = mesh_.triangle(triangle);
    if (is_before(t.y, t.x)) std::swap(t.x, t.y);
    if (is_before(t.z, t.y)) std::swap(t.y, t.z);
    if (is_before(t.y, t.x)) std::swap(t.x, t.y);
    return t;
  }

  const QuantizedMesh& mesh_;
};

}  // namespace

IndexSet find_duplicate_triangles(const QuantizedMesh& mesh, Work work) {
  return find_duplicates(mesh.triangle_count(), TriangleCorners(mesh), work, "quantize");
}

}  // namespace voxdag
