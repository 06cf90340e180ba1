#include "voxdag/builders/esvo/shape/convex_polyhedron.hpp"

#include <algorithm>
#include <bit>

namespace voxdag {

ConvexPolyhedron& ConvexPolyhedron::operator=(const ConvexPolyhedron& other) noexcept {
  if (this == &other) return *this;
  vertex_count_ = other.vertex_count_;
  edge_count_ = other.edge_count_;
  next_face_ = other.next_face_;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < vertex_count_; i += kLanes)
      std::memcpy(&at_[axis][i], &other.at_[axis][i], sizeof(FloatLanes));
  std::memcpy(edges_, other.edges_, static_cast<std::size_t>(edge_count_) * sizeof(Edge));
  return *this;
}

ConvexPolyhedron ConvexPolyhedron::cube() {
  ConvexPolyhedron p;
  p.vertex_count_ = 8;
  p.next_face_ = 6;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 8; ++i) p.at_[axis][i] = (i >> axis & 1) != 0 ? 1.0f : -1.0f;
  // The number of a face is 2 * axis + side.
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 8; ++i) {
      if ((i >> axis & 1) != 0) continue;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      p.edges_[p.edge_count_++] = {static_cast<std::uint8_t>(i),
                                   static_cast<std::uint8_t>(i | 1 << axis),
                                   static_cast<std::uint8_t>(2 * u + (i >> u & 1)),
                                   static_cast<std::uint8_t>(2 * v + (i >> v & 1))};
    }
  return p;
}

void ConvexPolyhedron::become_part(const ConvexPolyhedron& whole, Vec3f normal, float offset) {
  float distances[kMaxVertices + kLanes];
  for (int i = 0; i < whole.vertex_count_; i += kLanes)
    store_lanes(&distances[i], load_lanes(&whole.at_[0][i]) * normal.x +
                                   load_lanes(&whole.at_[1][i]) * normal.y +
                                   load_lanes(&whole.at_[2][i]) * normal.z - offset);
  become_part(whole, distances);
}

void ConvexPolyhedron::become_half(const ConvexPolyhedron& whole, int axis, bool is_upper) {
  float distances[kMaxVertices + kLanes];
  const float sign = is_upper ? -1.0f : 1.0f;
  for (int i = 0; i < whole.vertex_count_; i += kLanes)
    store_lanes(&distances[i], load_lanes(&whole.at_[axis][i]) * sign);
  become_part(whole, distances);
  for (int i = 0; i < vertex_count_; i += kLanes)
    store_lanes(&at_[axis][i], load_lanes(&at_[axis][i]) * 2.0f + sign);
}

void ConvexPolyhedron::become_part(const ConvexPolyhedron& whole, const float* distances) {
  // Avoids branches that depend on the plane's position, because processors cannot predict them.
  std::uint64_t outside = 0;
  for (int i = 0; i < whole.vertex_count_; i += kLanes)
    outside |= std::uint64_t{lane_bits(load_lanes(&distances[i]) > 0.0f)} << i;
  outside &= (std::uint64_t{1} << whole.vertex_count_) - 1;
  if (outside == 0) {
    *this = whole;
    return;
  }
  // The new index of each vertex, with kOut set for vertices that are cut away.
  constexpr std::uint8_t kOut = 0x80;
  std::uint8_t places[kMaxVertices];
  int count = 0;
  for (int i = 0; i < whole.vertex_count_; ++i) {
    const auto is_out = static_cast<int>(outside >> i & 1);
    places[i] = static_cast<std::uint8_t>(count | is_out << 7);
    for (int axis = 0; axis < 3; ++axis) at_[axis][count] = whole.at_[axis][i];
    count += 1 - is_out;
  }
  if (count == 0) {
    vertex_count_ = edge_count_ = 0;
    return;
  }

  std::uint8_t crossing[kMaxEdges];
  int crossings = 0, edge_count = 0;
  for (int i = 0; i < whole.edge_count_; ++i) {
    const Edge e = whole.edges_[i];
    const std::uint8_t a = places[e.a], b = places[e.b];
    edges_[edge_count] = {a, b, e.left, e.right};
    edge_count += ((a | b) >> 7) ^ 1;
    crossing[crossings] = static_cast<std::uint8_t>(i);
    crossings += (a ^ b) >> 7;
  }
  const int cut_face = whole.unused_face();
  if (cut_face == kMaxFaces || count + crossings > kMaxVertices ||
      edge_count + 2 * crossings > kMaxEdges - 1) {
    *this = whole;
    return;
  }
  next_face_ = std::max(whole.next_face_, cut_face + 1);

  // For each face: the first end of its cut, until the second end is found.
  std::uint8_t open_end[kMaxFaces];
  std::uint64_t open = 0;
  for (int k = 0; k < crossings; ++k) {
    const Edge e = whole.edges_[crossing[k]];
    const float share = distances[e.a] / (distances[e.a] - distances[e.b]);
    const auto end = static_cast<std::uint8_t>(count + k);
    for (int axis = 0; axis < 3; ++axis) {
      const float from = whole.at_[axis][e.a];
      at_[axis][end] = from + (whole.at_[axis][e.b] - from) * share;
    }
    const bool a_is_out = (places[e.a] & kOut) != 0;
    edges_[edge_count++] = {a_is_out ? end : places[e.a], a_is_out ? places[e.b] : end, e.left,
                            e.right};
    for (const std::uint8_t face : {e.left, e.right}) {
      edges_[edge_count] = {open_end[face], end, face, static_cast<std::uint8_t>(cut_face)};
      edge_count += static_cast<int>(open >> face & 1);
      open_end[face] = end;
      open ^= std::uint64_t{1} << face;
    }
  }
  vertex_count_ = count + crossings;
  edge_count_ = edge_count;
  fill_last_group();
}

int ConvexPolyhedron::unused_face() const {
  if (next_face_ < kMaxFaces) return next_face_;
  std::uint64_t faces = 0;
  for (int i = 0; i < edge_count_; ++i)
    faces |= std::uint64_t{1} << edges_[i].left | std::uint64_t{1} << edges_[i].right;
  return std::countr_one(faces);
}

void ConvexPolyhedron::fill_last_group() {
  for (float* const at : {at_[0], at_[1], at_[2]})
    store_lanes(&at[vertex_count_], all_lanes(at[0]));
}

ConvexPolyhedron ConvexPolyhedron::octant(int child) const {
  ConvexPolyhedron x, y, z;
  z.become_half(*this, 2, (child >> 2 & 1) != 0);
  y.become_half(z, 1, (child >> 1 & 1) != 0);
  x.become_half(y, 0, (child & 1) != 0);
  return x;
}

Vec3f ConvexPolyhedron::centre() const {
  Vec3f sum{};
  for (int i = 0; i < vertex_count_; ++i) sum = sum + vertex(i);
  return vertex_count_ > 0 ? sum * (1.0f / static_cast<float>(vertex_count_)) : sum;
}

}  // namespace voxdag
