/// Which corners and edges of displaced triangles are one place.
#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "voxdag/displace/displaced_triangles.hpp"

namespace voxdag {
namespace {

/// Near enough to count as equal where one then stands for both.
bool is_near(Vec3f a, Vec3f b) { return dot(a - b, a - b) < 1e-6f; }
bool is_near(Vec2f a, Vec2f b) {
  return std::abs(a.x - b.x) < 1e-6f && std::abs(a.y - b.y) < 1e-6f;
}

}  // namespace

void DisplacedTriangles::group() {
  const auto hash = [](Vec3f p) {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis)  // + 0: both zeros are one place.
      h = (h ^ std::bit_cast<std::uint32_t>(p[axis] + 0.0f)) * 0x9E3779B97F4A7C15ull, h ^= h >> 31;
    return static_cast<std::size_t>(h);
  };
  std::unordered_map<Vec3f, std::uint32_t, decltype(hash)> place_of(mesh_.vertices.size(), hash);
  places_.reserve(3 * mesh_.triangles.size());
  for (const Triangle& triangle : mesh_.triangles)
    for (const std::uint32_t vertex : triangle)
      places_.push_back(
          place_of.try_emplace(mesh_.vertices[vertex], static_cast<std::uint32_t>(place_of.size()))
              .first->second);
  group_corners(place_of.size());
  group_edges();
}

bool DisplacedTriangles::corners_agree(CornerIndex a, CornerIndex b) const {
  const std::uint32_t s = a / 3, t = b / 3;
  return Appearance::material_index(mesh_, s) == Appearance::material_index(mesh_, t) &&
         is_near(normals(s)[a % 3], normals(t)[b % 3]) &&
         (displacement(s).box_size > 0 || is_near(uv(a), uv(b)));
}

bool DisplacedTriangles::edges_agree(CornerIndex a, CornerIndex b) const {
  const CornerIndex a_end = next_corner(a), b_end = next_corner(b);
  return places_[a] == places_[b] ? corners_agree(a, b) && corners_agree(a_end, b_end)
                                  : corners_agree(a, b_end) && corners_agree(a_end, b);
}

void DisplacedTriangles::group_corners(std::size_t place_count) {
  std::vector<std::uint32_t> starts(place_count + 1);
  for (const std::uint32_t place : places_) ++starts[place + 1];
  for (std::size_t i = 0; i < place_count; ++i) starts[i + 1] += starts[i];
  std::vector<CornerIndex> sorted(places_.size());
  std::vector<std::uint32_t> ends(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < places_.size(); ++i)
    sorted[ends[places_[i]]++] = static_cast<CornerIndex>(i);
  corner_groups_ = places_;
  groups_.reserve(place_count + places_.size() / 2);
  for (std::size_t place = 0; place < place_count; ++place)
    add_group({sorted.data() + starts[place], sorted.data() + starts[place + 1]},
              [this](CornerIndex a, CornerIndex b) { return corners_agree(a, b); });
}

void DisplacedTriangles::group_edges() {
  const auto key = [this](CornerIndex edge) {
    const auto [lo, hi] = std::minmax(places_[edge], places_[next_corner(edge)]);
    return std::uint64_t{lo} << 32 | hi;
  };
  std::vector<std::pair<std::uint64_t, CornerIndex>> edges(places_.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto edge = static_cast<CornerIndex>(i);
    edges[i] = {key(edge), edge};
  }
  std::sort(edges.begin(), edges.end());
  edge_groups_.resize(edges.size());
  std::vector<CornerIndex> sides;
  for (std::size_t first = 0; first < edges.size();) {
    sides.clear();
    std::size_t last = first;
    for (; last < edges.size() && edges[last].first == edges[first].first; ++last) {
      edge_groups_[edges[last].second] = static_cast<std::uint32_t>(groups_.size());
      sides.push_back(edges[last].second);
    }
    add_group(sides, [this](CornerIndex a, CornerIndex b) { return edges_agree(a, b); });
    first = last;
  }
}

}  // namespace voxdag
