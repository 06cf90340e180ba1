#pragma once
/// Texture coordinates, normals and vertex colours of an OBJ file.
#include <atomic>
#include <cstdint>
#include <limits>
#include <string_view>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/formats/readers/obj/obj_passes.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Indices of the values that a corner refers to.
struct ObjReferences {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t uv = kNone, normal = kNone;
};

/// Holds the file's values and the references of all corners until every value is known, because
/// faces may precede their values. Threads may set distinct values and corners concurrently.
class ObjAttributes {
 public:
  /// Makes room for all values and corners of the file. Throws OverMemory.
  ObjAttributes(const MeshSource& source, const ObjCounts& totals, bool has_colors);

  void set_uv(std::size_t index, std::string_view numbers);
  void set_normal(std::size_t index, std::string_view numbers);
  /// Sets the colour of a vertex from the numbers that follow its coordinates, if there are three.
  void set_color(std::size_t vertex, std::string_view numbers);

  /// Parses "vt" and "vn" of a corner "v/vt/vn". `seen` counts the values that precede the face in
  /// the file. A reference to a value that does not exist counts as bad.
  ObjReferences parse_references(std::string_view corner, const ObjCounts& seen);
  /// Sets the references of the three corners of a triangle.
  void set_references(std::size_t triangle, const ObjReferences& a, const ObjReferences& b,
                      const ObjReferences& c);

  /// Replaces the references by their values. Call it once, at the end. Throws OverMemory.
  void finish(Appearance& appearance);
  /// Joins the colours of vertices, if there are some, with the materials, which must be complete.
  /// A vertex's colour replaces the base colour of its material. A vertex without a colour keeps
  /// it.
  void join_colors(const Mesh& mesh, MeshWithAppearance& read);

  bool has_colors() const { return !colors_.empty(); }
  std::size_t bad_references() const { return bad_references_; }

 private:
  template <class T>
  void look_up(CountedVector<std::uint32_t>& references, CountedVector<T>& values,
               std::vector<T>& result);

  const MeshSource& source_;
  const ObjCounts totals_;
  CountedVector<Vec2f> uvs_;
  CountedVector<Vec3f> normals_;
  CountedVector<Vec3f> colors_;  ///< Per vertex: sRGB as in the file; NaN: none.
  CountedVector<std::uint32_t> uv_references_, normal_references_;  ///< Per corner.
  MemoryReservation results_;                                       ///< The appearance's arrays.
  std::atomic<std::size_t> bad_references_{0};
};

}  // namespace voxdag
