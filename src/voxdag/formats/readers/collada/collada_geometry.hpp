#pragma once
/// The meshes of a COLLADA document.
#include <cstdint>
#include <map>
#include <span>
#include <string_view>

#include "voxdag/formats/readers/collada/collada_document.hpp"
#include "voxdag/formats/readers/collada/collada_materials.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A mesh of the document. All indices are in range.
struct ColladaGeometry {
  explicit ColladaGeometry(MemoryBudget* memory) : vertices(memory), triangles(memory) {}
  CountedVector<Vec3d> vertices;
  CountedVector<Triangle> triangles;
  CountedVector<std::uint32_t> symbols{triangles.get_allocator()};  ///< ColladaMaterials::symbol().
};

/// Reads each <geometry> once.
class ColladaGeometries {
 public:
  ColladaGeometries(const ColladaDocument& document, ColladaMaterials& materials)
      : document_(document), materials_(materials) {}

  /// Returns the mesh of a <geometry>; empty if it is no mesh. Throws Error, OverMemory, Cancelled.
  const ColladaGeometry& read(const XmlElement& element);

  /// Counts the parts of the shapes, and of their appearance, that the reader leaves out.
  const LeftOut& left_out_shapes() const { return left_out_shapes_; }
  const LeftOut& left_out_looks() const { return left_out_looks_; }

 private:
  /// The place of vertex numbers in a primitive's list of indices.
  struct IndexLayout {
    std::uint64_t vertex = 0, stride = 1;
  };

  void read_mesh(const XmlElement& element, ColladaGeometry& geometry);
  void read_positions(const XmlElement& element, CountedVector<Vec3d>& positions) const;
  void read_primitive(const XmlElement& primitive, ColladaGeometry& geometry);
  IndexLayout layout_of(const XmlElement& primitive);
  void read_corners(std::string_view text, const IndexLayout& layout, std::uint64_t vertices,
                    CountedVector<std::uint32_t>& corners) const;
  void add_triangle(ColladaGeometry& geometry, Triangle corners) const;
  void add_polygon(ColladaGeometry& geometry, std::span<const std::uint32_t> corners) const;

  const ColladaDocument& document_;
  ColladaMaterials& materials_;
  std::map<const XmlElement*, ColladaGeometry> geometries_;
  std::uint32_t symbol_ = 0;  ///< Of the primitive that is read.
  LeftOut left_out_shapes_, left_out_looks_;
};

}  // namespace voxdag
