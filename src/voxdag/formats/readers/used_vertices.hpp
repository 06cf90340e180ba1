#pragma once
/// The vertices that triangles use.
#include "voxdag/core/box.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// The vertices that triangles use, without triangles that have a vertex that is not finite.
struct UsedVertices {
  Box3f bounds = Box3f::empty();    ///< As in Mesh::vertices.
  std::uint64_t bad_triangles = 0;  ///< Triangles that have a vertex that is not finite.

  /// Adds a triangle. Returns whether its vertices are finite.
  bool add(Vec3f a, Vec3f b, Vec3f c) {
    const bool is_good = is_finite(a) && is_finite(b) && is_finite(c);
    bad_triangles += is_good ? 0 : 1;
    if (is_good)
      for (const Vec3f corner : {a, b, c}) bounds.extend(corner);
    return is_good;
  }
  void add(const UsedVertices& more) {
    bad_triangles += more.bad_triangles;
    bounds = {min(bounds.lo, more.bounds.lo), max(bounds.hi, more.bounds.hi)};
  }
};

/// Inspects all triangles of a mesh that a reader has returned. Throws Cancelled.
UsedVertices used_vertices(const MeshSource& source, const Mesh& mesh);

/// Removes the triangles that have a vertex that is not finite, and adds a warning with their
/// number if there are some. Throws Error if no triangle is left, and Cancelled.
void remove_bad_triangles(const MeshSource& source, std::uint64_t bad_triangles,
                          MeshWithAppearance& read);

/// Returns the warning about triangles that are left out.
std::string bad_triangles_warning(const std::string& file, std::uint64_t bad_triangles);
inline constexpr const char* kNoGoodTriangle = "every triangle has a vertex that is not finite";

}  // namespace voxdag
