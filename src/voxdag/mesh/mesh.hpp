#pragma once
/// An indexed triangle mesh.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "voxdag/core/array_store.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Returns a point that is measured from `origin` in world coordinates.
inline Vec3d from_origin(Vec3d origin, Vec3f local) {
  const auto p = static_cast<Vec3d>(local);
  return origin == Vec3d{} ? p : p + origin;  // -0 + 0 would be 0.
}

using Triangle = std::array<std::uint32_t, 3>;  ///< Three indices into Mesh::vertices.

/// A run of triangles that belong to one object, up to the first of the next run.
struct ObjectRun {
  std::uint64_t first_triangle = 0;
  std::uint32_t object = 0;  ///< Index into Mesh::objects.
  friend bool operator==(const ObjectRun&, const ObjectRun&) = default;
};

/// A mesh from a reader has only indices in range, and every vertex that a triangle references is
/// finite. Copies of a mesh are on the heap; moved arrays stay where they are.
struct Mesh {
  StoredVector<Vec3f> vertices;  ///< World units, from `origin`. The nearest float32 of the file's.
  StoredVector<Triangle> triangles;
  StoredVector<std::uint32_t> triangle_materials;  ///< Index into `materials`, or empty: no names.
  std::vector<std::string> materials;              ///< Names as in the file.
  /// Names of the file's objects, and the runs of its triangles, in order, if ReadOptions::objects
  /// asks for them; both empty if the file names none.
  std::vector<std::string> objects = {};
  std::vector<ObjectRun> object_runs = {};
  /// World units. 0 along each axis along which the mesh is near 0: see float_origin().
  Vec3d origin{};

  /// Returns a vertex, or another point that is measured from `origin`, in world coordinates.
  Vec3d to_world(Vec3f local) const { return from_origin(origin, local); }
  Vec3d position(std::size_t vertex) const { return to_world(vertices[vertex]); }
};

/// Returns an empty mesh whose arrays will grow in `store`; on the heap if it is null.
inline Mesh empty_mesh(ArrayStore* store) {
  return {StoredVector<Vec3f>(store),
          StoredVector<Triangle>(store),
          StoredVector<std::uint32_t>(store),
          {},
          {},
          {},
          {}};
}

}  // namespace voxdag
