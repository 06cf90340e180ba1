#include "voxdag/builders/pieces/duplicate_surfaces.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace voxdag {
namespace {

/// All that distinguishes a corner, as words of bits.
using CornerWords = std::array<std::uint32_t, 10>;

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 29;
}

class TriangleSurfaces {
 public:
  TriangleSurfaces(const Mesh& mesh, const Appearance* appearance)
      : mesh_(mesh), appearance_(appearance) {}

  /// Returns a hash that is equal for equal triangles, whichever corner comes first.
  std::optional<std::uint64_t> hash(std::size_t triangle) const {
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

IndexSet find_duplicate_surfaces(const Mesh& mesh, const Appearance* appearance, Work work) {
  return find_duplicates(mesh.triangles.size(), TriangleSurfaces(mesh, appearance), work,
                         "duplicates");
}

}  // namespace voxdag
