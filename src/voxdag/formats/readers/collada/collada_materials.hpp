#pragma once
/// The materials of a COLLADA document.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/collada/collada_document.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Collects the materials that instances of meshes use. Primitives name symbols; each instance
/// binds them to materials.
class ColladaMaterials {
 public:
  explicit ColladaMaterials(const ColladaDocument& document);

  /// Returns the number of a symbol; 0 stands for "".
  std::uint32_t symbol(std::string_view name);
  /// Returns the material of each symbol in an instance. Throws Error if it names a material or an
  /// effect that does not exist.
  std::vector<std::uint32_t> bound_by(const XmlElement& instance);

  /// The materials so far. The first one is grey, for symbols that are not bound.
  const std::vector<Material>& materials() const { return materials_; }
  const LeftOut& left_out() const { return left_out_; }

 private:
  std::uint32_t number_of(const XmlElement& material);
  void read_colors(const XmlElement& effect, Material& material);
  void read_color(const XmlElement& effect, const XmlElement& property, Vec3f& color);

  const ColladaDocument& document_;
  std::map<std::string, std::uint32_t, std::less<>> symbols_{{"", 0}};
  std::map<const XmlElement*, std::uint32_t> numbers_;
  std::vector<Material> materials_{1};
  LeftOut left_out_;
};

}  // namespace voxdag
