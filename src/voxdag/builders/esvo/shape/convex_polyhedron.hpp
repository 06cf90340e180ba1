#pragma once
/// A convex polyhedron that is cut repeatedly: the part of a voxel's cube that remains after the
/// cuts by its own contour and those of its ancestors.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4.
///
/// It stores vertices, and edges with their two faces. When a plane cuts the edges of a face, the
/// two new ends are the ends of the new edge in that face. Rounding may lose an edge of a sliver.
/// The shape is then slightly wrong, which can only reduce quality: contours enclose the surface in
/// any case.
#include <cstdint>

#include "voxdag/core/lanes.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

class ConvexPolyhedron {
 public:
  static constexpr int kMaxVertices = 44, kMaxEdges = 64;

  // Most polyhedra use only a few of the kMaxVertices vertices and kMaxEdges edges; copies leave
  // out the rest.
  ConvexPolyhedron() {}
  ConvexPolyhedron(const ConvexPolyhedron& other) noexcept { *this = other; }
  ConvexPolyhedron& operator=(const ConvexPolyhedron& other) noexcept;

  /// Returns the cube [-1,1]³.
  static ConvexPolyhedron cube();

  /// Becomes the part of `whole`, another polyhedron, where dot(normal, p) <= offset. Becomes all
  /// of `whole` if the part would need too many vertices or edges. May become empty.
  void become_part(const ConvexPolyhedron& whole, Vec3f normal, float offset);

  /// Becomes the half of `whole`, another polyhedron, on one side of 0 along an axis. Stretches the
  /// half along the axis, from [0,1] or [-1,0] to [-1,1].
  void become_half(const ConvexPolyhedron& whole, int axis, bool is_upper);

  /// Returns the part in octant `child` (x=1, y=2, z=4) of [-1,1]³, enlarged to [-1,1]³.
  ConvexPolyhedron octant(int child) const;

  int vertex_count() const { return vertex_count_; }
  Vec3f vertex(int i) const { return {at_[0][i], at_[1][i], at_[2][i]}; }
  /// Returns one coordinate of all vertices, in groups of four; the last group is padded with
  /// copies of vertices.
  const float* coordinates(int axis) const { return at_[axis]; }
  bool is_empty() const { return vertex_count_ == 0; }
  /// Returns the mean of the vertices.
  Vec3f centre() const;

 private:
  struct Edge {
    std::uint8_t a, b;         // its end vertices
    std::uint8_t left, right;  // its faces
  };

  /// Becomes the part of `whole`, another polyhedron, where the interpolated `distances` of its
  /// vertices are not positive.
  void become_part(const ConvexPolyhedron& whole, const float* distances);
  void fill_last_group();
  /// Returns the number of an unused face, or kMaxFaces if there is none.
  int unused_face() const;

  static constexpr int kMaxFaces = 64;

  int vertex_count_ = 0, edge_count_ = 0;
  int next_face_ = 0;  // no edge has this face or a later one
  union {
    float at_[3][kMaxVertices + kLanes];  // uninitialised
  };
  Edge edges_[kMaxEdges];
};

}  // namespace voxdag
