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

#include "voxdag/core/vec.hpp"

namespace voxdag {

class ConvexPolyhedron {
 public:
  static constexpr int kMaxVertices = 64, kMaxEdges = 96, kMaxFaces = 64;

  // Most have a few of the vertices and edges that there is room for: copies leave out the rest.
  ConvexPolyhedron() {}
  ConvexPolyhedron(const ConvexPolyhedron& other) { *this = other; }
  ConvexPolyhedron& operator=(const ConvexPolyhedron& other);

  /// The cube [-1,1]³.
  static ConvexPolyhedron cube();

  /// Cuts away where dot(normal, p) > offset. Where the result would be too complex it stays as it
  /// was. What is left may be empty.
  void clip(Vec3f normal, float offset);

  /// Of the octant `child` (x=1, y=2, z=4) of [-1,1]³, enlarged to [-1,1]³.
  ConvexPolyhedron octant(int child) const;

  int vertex_count() const { return vertex_count_; }
  Vec3f vertex(int i) const { return vertices_[i]; }
  bool is_empty() const { return vertex_count_ == 0; }
  /// The mean of the vertices.
  Vec3f centre() const;

 private:
  struct Edge {
    std::uint8_t a, b;         // vertices
    std::uint8_t left, right;  // faces
  };

  /// Cuts by plane distances given for each vertex, positive outside.
  void clip(const float* distances);

  int vertex_count_ = 0, edge_count_ = 0;
  union {
    Vec3f vertices_[kMaxVertices];  // uninitialised
  };
  Edge edges_[kMaxEdges];
};

}  // namespace voxdag
