#include "voxdag/mesh/displace/displacement_seams.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "voxdag/core/parallel/polled_sort.hpp"

namespace voxdag {
namespace {

/// Returns whether two normals, or two texture coordinates, are so close that they count as equal.
bool is_near(Vec3f a, Vec3f b) { return dot(a - b, a - b) < 1e-6f; }
bool is_near(Vec2f a, Vec2f b) {
  return std::abs(a.x - b.x) < 1e-6f && std::abs(a.y - b.y) < 1e-6f;
}

/// Returns whether two triangles move a common corner by equal offsets.
bool corners_agree(const DisplacedMesh& mesh, CornerIndex a, CornerIndex b) {
  const std::uint32_t s = a / 3, t = b / 3;
  return Appearance::material_index(mesh.mesh, s) == Appearance::material_index(mesh.mesh, t) &&
         is_near(mesh.normals(s)[a % 3], mesh.normals(t)[b % 3]) &&
         (mesh.displacement(s).box_size > 0 || is_near(mesh.uv(a), mesh.uv(b)));
}

struct PositionHash {
  std::size_t operator()(Vec3f p) const {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis)  // + 0 turns -0 into 0, so that their hashes are equal.
      h = (h ^ std::bit_cast<std::uint32_t>(p[axis] + 0.0f)) * 0x9E3779B97F4A7C15ull, h ^= h >> 31;
    return h;
  }
};

/// Reports the progress of one of three passes over the mesh, from time to time.
void report(Work work, int pass, std::size_t item, std::size_t count) {
  if (item % 65536 != 0) return;
  work.poll();
  const double part = static_cast<double>(item) / static_cast<double>(count);
  work.report("displacement seams", (pass + part) / 3, item);
}

}  // namespace

DisplacementSeams::DisplacementSeams(const DisplacedMesh& mesh, Work work)
    : places_(work.memory),
      corner_groups_(work.memory),
      edge_groups_(work.memory),
      groups_(work.memory),
      members_(work.memory) {
  number_places(mesh.mesh, work);
  group_corners(mesh, work);
  group_edges(mesh, work);
}

void DisplacementSeams::number_places(const Mesh& mesh, Work work) {
  using PlaceOf = std::unordered_map<Vec3f, std::uint32_t, PositionHash, std::equal_to<>,
                                     CountedAllocator<std::pair<const Vec3f, std::uint32_t>>>;
  PlaceOf place_of(mesh.vertices.size(), PlaceOf::allocator_type(places_.get_allocator()));
  places_.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    report(work, 0, i, mesh.triangles.size());
    for (const std::uint32_t vertex : mesh.triangles[i])
      places_.push_back(
          place_of.try_emplace(mesh.vertices[vertex], static_cast<std::uint32_t>(place_of.size()))
              .first->second);
  }
  place_count_ = place_of.size();
}

bool DisplacementSeams::edges_agree(const DisplacedMesh& mesh, CornerIndex a, CornerIndex b) const {
  const CornerIndex a_end = next_corner(a), b_end = next_corner(b);
  return places_[a] == places_[b] ? corners_agree(mesh, a, b) && corners_agree(mesh, a_end, b_end)
                                  : corners_agree(mesh, a, b_end) && corners_agree(mesh, a_end, b);
}

/// Adds the group of coinciding corners or edges. Its members are those that agree with no earlier
/// member.
template <class Agree>
void DisplacementSeams::add_group(const DisplacedMesh& mesh, std::span<const CornerIndex> all,
                                  const Agree& agree) {
  StoredGroup group{static_cast<std::uint32_t>(members_.size()), 0, false};
  for (const CornerIndex corner : all) {
    group.is_pinned |= !mesh.is_displaced(corner / 3) || group.count > kMaxMembers;
    // A pinned group needs only its first member.
    if (group.is_pinned && group.count > 0) break;
    bool is_known = false;
    for (std::uint32_t i = 0; i < group.count && !is_known; ++i)
      is_known = agree(members_[group.first + i], corner);
    if (is_known) continue;
    members_.push_back(corner);
    ++group.count;
  }
  groups_.push_back(group);
}

void DisplacementSeams::group_corners(const DisplacedMesh& mesh, Work work) {
  const auto allocator = places_.get_allocator();
  // Counting sort of the corners by place.
  CountedVector<std::uint32_t> starts(place_count_ + 1, allocator);
  for (const std::uint32_t place : places_) ++starts[place + 1];
  for (std::size_t i = 0; i < place_count_; ++i) starts[i + 1] += starts[i];
  CountedVector<CornerIndex> sorted(places_.size(), allocator);
  CountedVector<std::uint32_t> ends(starts.begin(), starts.end() - 1, allocator);
  for (std::size_t i = 0; i < places_.size(); ++i)
    sorted[ends[places_[i]]++] = static_cast<CornerIndex>(i);
  corner_groups_ = places_;
  groups_.reserve(place_count_ + places_.size() / 2);
  for (std::size_t place = 0; place < place_count_; ++place) {
    report(work, 1, place, place_count_);
    add_group(mesh, {sorted.data() + starts[place], sorted.data() + starts[place + 1]},
              [&](CornerIndex a, CornerIndex b) { return corners_agree(mesh, a, b); });
  }
}

void DisplacementSeams::group_edges(const DisplacedMesh& mesh, Work work) {
  const auto key = [this](CornerIndex edge) {
    const Ends e = ends(edge);
    return std::uint64_t{places_[e.first]} << 32 | places_[e.last];
  };
  const auto allocator = places_.get_allocator();
  CountedVector<std::pair<std::uint64_t, CornerIndex>> edges(places_.size(), allocator);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto edge = static_cast<CornerIndex>(i);
    edges[i] = {key(edge), edge};
  }
  polled_sort(edges.begin(), edges.end(), work);
  edge_groups_.resize(edges.size());
  CountedVector<CornerIndex> coinciding(allocator);
  for (std::size_t first = 0; first < edges.size();) {
    report(work, 2, first, edges.size());
    coinciding.clear();
    std::size_t last = first;
    for (; last < edges.size() && edges[last].first == edges[first].first; ++last) {
      edge_groups_[edges[last].second] = static_cast<std::uint32_t>(groups_.size());
      coinciding.push_back(edges[last].second);
    }
    add_group(mesh, coinciding,
              [&](CornerIndex a, CornerIndex b) { return edges_agree(mesh, a, b); });
    first = last;
  }
}

}  // namespace voxdag
