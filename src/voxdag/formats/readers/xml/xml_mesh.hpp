#pragma once
/// A mesh that is made of transformed copies of others: for readers of scenes in XML.
#include <cstdint>
#include <span>
#include <string_view>

#include "voxdag/formats/readers/affine_transform.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// The most copies of meshes: nested references make any number of them from a small file.
inline constexpr std::uint64_t kMaxXmlInstances = std::uint64_t{1} << 24;

/// A mesh of known size that grows by one copy after the other.
class InstancedMesh {
 public:
  /// Reserves memory for all copies. Throws OverMemory, and Error if there are more than 2^32 - 2
  /// vertices, or no triangles.
  InstancedMesh(const MeshSource& source, std::uint64_t vertices, std::uint64_t triangles);

  /// Starts a copy: triangles count their vertices from here.
  void begin_instance(const AffineTransform& transform);
  /// Adds a vertex of the copy.
  void add_vertex(Vec3d position);
  /// Adds a triangle of the copy's vertices, which exist. Turns it if the transform mirrors.
  void add_triangle(Triangle corners, std::uint32_t material);

  /// Returns the mesh.
  Mesh take() { return std::move(mesh_); }

 private:
  const MeshSource& source_;
  MemoryReservation memory_;
  Mesh mesh_;
  AffineTransform transform_;
  std::uint32_t first_vertex_ = 0;
  bool is_mirrored_ = false;
};

/// Removes the next word, up to a blank or a line end, from the text and returns it; empty at the
/// end.
std::string_view take_word(std::string_view& text);

/// Parses as many numbers as `values` has. Throws Error without a file, which calls the text
/// `what`, if there are more or fewer, or if one is not finite.
void parse_exact_numbers(std::string_view text, std::span<double> values, const char* what);

/// Removes the next number from the text and returns it. Throws Error without a file, which calls
/// it `what`, if it is no whole number below `end`.
std::uint32_t take_index(std::string_view& text, std::uint64_t end, const char* what);

}  // namespace voxdag
