#pragma once
/// A convex polyhedron that is cut smaller and smaller: what is left of a voxel's cube between the
/// contours of its ancestors and its own.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4.
///
/// Edges that know their two faces are all it takes: the cut ends of the edges around a face are
/// the ends of the new edge that the cut makes across it. Rounding may lose an edge of a sliver;
/// the shape then is a little off, which costs quality at most: contours are made to enclose the
/// surface, whatever this says.
#include <cstdint>

#include "voxdag/core/lanes.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

class ConvexPolyhedron {
 public:
  static constexpr int kMaxVertices = 44, kMaxEdges = 64;

  // Most have a few of the vertices and edges that there is room for: copies leave out the rest.
  ConvexPolyhedron() {}
  ConvexPolyhedron(const ConvexPolyhedron& other) noexcept { *this = other; }
  ConvexPolyhedron& operator=(const ConvexPolyhedron& other) noexcept;

  /// The cube [-1,1]³.
  static ConvexPolyhedron cube();

  /// Becomes what is left of `whole`, which is another, where dot(normal, p) <= offset; all of it
  /// where the result would be too complex. May become empty.
  void become_part(const ConvexPolyhedron& whole, Vec3f normal, float offset);

  /// Becomes the half of `whole`, which is another, on one side of 0 along an axis, stretched along
  /// it: what was [0,1] or [-1,0] is [-1,1] then.
  void become_half(const ConvexPolyhedron& whole, int axis, bool is_upper);

  /// Of the octant `child` (x=1, y=2, z=4) of [-1,1]³, enlarged to [-1,1]³.
  ConvexPolyhedron octant(int child) const;

  int vertex_count() const { return vertex_count_; }
  Vec3f vertex(int i) const { return {at_[0][i], at_[1][i], at_[2][i]}; }
  /// A coordinate of the vertices, in groups of four; the last group is filled up with vertices.
  const float* coordinates(int axis) const { return at_[axis]; }
  bool is_empty() const { return vertex_count_ == 0; }
  /// The mean of the vertices.
  Vec3f centre() const;

 private:
  struct Edge {
    std::uint8_t a, b;         // vertices
    std::uint8_t left, right;  // faces
  };

  /// Becomes what is left of `whole`, another one, where the distances of its vertices are not
  /// positive.
  void become_part(const ConvexPolyhedron& whole, const float* distances);
  void fill_last_group();
  /// kMaxFaces if there is none.
  int unused_face() const;

  static constexpr int kMaxFaces = 64;

  int vertex_count_ = 0, edge_count_ = 0;
  int next_face_ = 0;  // no edge has this one or a later one
  union {
    float at_[3][kMaxVertices + kLanes];  // uninitialised
  };
  Edge edges_[kMaxEdges];
};

}  // namespace voxdag
