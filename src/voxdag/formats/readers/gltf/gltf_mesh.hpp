#pragma once
/// A glTF mesh, checked and ready to be written once per instance.
#include <array>
#include <cstdint>

#include "voxdag/formats/readers/gltf/gltf_accessor.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {

/// The modes in which corners make triangles. Smaller modes make points and lines.
enum GltfMode : std::uint64_t { kGltfTriangles = 4, kGltfStrip = 5, kGltfFan = 6 };

struct GltfPrimitive {
  GltfValue value;
  std::uint64_t mode = kGltfTriangles;
  const GltfAccessor* positions = nullptr;
  const GltfAccessor* indices = nullptr;  ///< Null: the corners are the positions in order.
  std::uint64_t triangles = 0;
  std::uint32_t first_vertex = 0;  ///< Its first position in the mesh; may be shared.
  bool adds_vertices = false;      ///< It is the first primitive with its positions.
  std::uint32_t material = 0;      ///< The number of materials if it has none.
  /// The attributes, if they are read. Null if the primitive has none.
  const GltfAccessor *normals = nullptr, *uvs = nullptr, *colors = nullptr;
};

/// The primitives that add vertices or triangles, and their totals.
struct GltfMesh {
  explicit GltfMesh(MemoryBudget* memory) : primitives(memory) {}

  CountedVector<GltfPrimitive> primitives;
  std::uint64_t vertices = 0, triangles = 0;
  bool has_default_material = false;  ///< A primitive has no material.
};

/// Checks a mesh. With `warnings`, also finds the attributes, and leaves malformed ones out with a
/// warning. Throws Error, OverMemory, Cancelled.
GltfMesh compile_gltf_mesh(const GltfFile& file, const GltfValue& mesh, GltfAccessors& accessors,
                           Warnings* warnings);

/// Returns the corners of triangle `i`, in the order of the glTF specification (3.7.2.1).
inline std::array<std::size_t, 3> gltf_triangle_corners(std::uint64_t mode, std::size_t i) {
  if (mode == kGltfTriangles) return {3 * i, 3 * i + 1, 3 * i + 2};
  if (mode == kGltfStrip) return {i, i + 1 + i % 2, i + 2 - i % 2};
  return {i + 1, i + 2, 0};
}

}  // namespace voxdag
