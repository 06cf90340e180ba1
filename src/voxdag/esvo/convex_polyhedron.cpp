#include "voxdag/esvo/convex_polyhedron.hpp"

#include <algorithm>
#include <bit>
#include <initializer_list>

namespace voxdag {

ConvexPolyhedron& ConvexPolyhedron::operator=(const ConvexPolyhedron& other) {
  if (this == &other) return *this;
  vertex_count_ = other.vertex_count_;
  edge_count_ = other.edge_count_;
  std::copy_n(other.vertices_, vertex_count_, vertices_);
  std::copy_n(other.edges_, edge_count_, edges_);
  return *this;
}

ConvexPolyhedron ConvexPolyhedron::cube() {
  ConvexPolyhedron p;
  for (int i = 0; i < 8; ++i)
    p.vertices_[p.vertex_count_++] = {(i & 1) != 0 ? 1.0f : -1.0f, (i & 2) != 0 ? 1.0f : -1.0f,
                                      (i & 4) != 0 ? 1.0f : -1.0f};
  // Face 2 * axis + side.
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

void ConvexPolyhedron::clip(Vec3f normal, float offset) {
  float distances[kMaxVertices];
  for (int i = 0; i < vertex_count_; ++i) distances[i] = dot(normal, vertices_[i]) - offset;
  clip(distances);
}

void ConvexPolyhedron::clip(const float* distances) {
  constexpr std::uint8_t kNone = 255;
  std::uint8_t kept[kMaxVertices];
  int count = 0;
  for (int i = 0; i < vertex_count_; ++i)
    kept[i] = distances[i] <= 0 ? static_cast<std::uint8_t>(count++) : kNone;
  if (count == vertex_count_) return;
  if (count == 0) {
    vertex_count_ = edge_count_ = 0;
    return;
  }

  std::uint64_t faces = 0;
  int crossings = 0;
  for (int i = 0; i < edge_count_; ++i) {
    const Edge& e = edges_[i];
    faces |= std::uint64_t{1} << e.left | std::uint64_t{1} << e.right;
    crossings += (kept[e.a] == kNone) != (kept[e.b] == kNone) ? 1 : 0;
  }
  if (faces == ~std::uint64_t{0} || count + crossings > kMaxVertices ||
      edge_count_ + crossings > kMaxEdges)
    return;
  const auto cut_face = static_cast<std::uint8_t>(std::countr_one(faces));

  // Kept vertices move down to their new places once no edge needs the old ones.
  float ends[kMaxEdges][3];
  Edge edges[kMaxEdges];
  int edge_count = 0, end_count = 0;
  // The end of an edge across a face that has been found, where the other has not.
  std::uint8_t open_end[kMaxFaces];
  std::uint64_t open = 0;
  for (int i = 0; i < edge_count_; ++i) {
    const Edge e = edges_[i];
    const std::uint8_t a = kept[e.a], b = kept[e.b];
    if (a == kNone && b == kNone) continue;
    if (a != kNone && b != kNone) {
      edges[edge_count++] = {a, b, e.left, e.right};
      continue;
    }
    const float da = distances[e.a], db = distances[e.b];
    const Vec3f at = vertices_[e.a] + (vertices_[e.b] - vertices_[e.a]) * (da / (da - db));
    const auto end = static_cast<std::uint8_t>(count + end_count);
    ends[end_count][0] = at.x, ends[end_count][1] = at.y, ends[end_count][2] = at.z;
    ++end_count;
    edges[edge_count++] = {a != kNone ? a : end, a != kNone ? end : b, e.left, e.right};
    for (const std::uint8_t face : {e.left, e.right}) {
      const std::uint64_t bit = std::uint64_t{1} << face;
      if ((open & bit) == 0) {
        open_end[face] = end;
      } else if (edge_count < kMaxEdges) {
        edges[edge_count++] = {open_end[face], end, face, cut_face};
      }
      open ^= bit;
    }
  }
  for (int i = 0; i < vertex_count_; ++i)
    if (kept[i] != kNone) vertices_[kept[i]] = vertices_[i];
  for (int i = 0; i < end_count; ++i) vertices_[count + i] = {ends[i][0], ends[i][1], ends[i][2]};
  vertex_count_ = count + end_count;
  edge_count_ = edge_count;
  std::copy_n(edges, edge_count, edges_);
}

ConvexPolyhedron ConvexPolyhedron::octant(int child) const {
  ConvexPolyhedron p = *this;
  for (int axis = 0; axis < 3; ++axis) {
    const float sign = (child >> axis & 1) != 0 ? -1.0f : 1.0f;
    float distances[kMaxVertices];
    for (int i = 0; i < p.vertex_count_; ++i) distances[i] = sign * p.vertices_[i][axis];
    p.clip(distances);
  }
  for (int i = 0; i < p.vertex_count_; ++i)
    for (int axis = 0; axis < 3; ++axis)
      p.vertices_[i][axis] = 2 * p.vertices_[i][axis] - ((child >> axis & 1) != 0 ? 1.0f : -1.0f);
  return p;
}

Vec3f ConvexPolyhedron::centre() const {
  Vec3f sum{};
  for (int i = 0; i < vertex_count_; ++i) sum = sum + vertices_[i];
  return vertex_count_ > 0 ? sum * (1.0f / static_cast<float>(vertex_count_)) : sum;
}

}  // namespace voxdag
