#pragma once
/// The options of `voxdag build` for colours, normals, materials and channels on a DAG.
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "cli/mesh_input.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/file/vdag_metadata.hpp"

namespace voxdag::cli {

/// The kind of ids that --material-ids stores. kDefault: materials, or objects if the mesh has no
/// materials.
enum class IdKind { kDefault, kMaterial, kObject, kFile };

struct AttributeArguments {
  AttributeOptions options;
  bool colors_if_any = false;  ///< Store colours if the mesh has some.
  IdKind ids = IdKind::kDefault;
  std::optional<Value8> inside_color;  ///< Inside of solids, sRGB. Empty: as the nearest surface.
  std::optional<int> levels;           ///< log2 of --attribute-resolution.
  std::optional<bool> cut;             ///< Whether --alpha is "cut"; empty: not given.

  bool needs_shading() const { return options.colors || options.normals || options.has_channels(); }
  bool needs_appearance() const { return needs_shading() || colors_if_any || cuts_alpha(); }
  bool is_wanted() const { return needs_shading() || options.materials; }
  /// Returns whether voxels that the alpha test removes are not set.
  bool cuts_alpha() const { return cut.value_or(options.colors); }
  /// Throws UsageError if the attributes would be finer than a DAG of `dag_levels`.
  void check_levels(int dag_levels) const;
};

/// By default, attributes have the finest resolution at which they are expected to fit into this
/// many bytes.
inline constexpr std::uint64_t kAttributeBudget = std::uint64_t{4} << 30;

/// Adds the options. They call `is_solid` once all options are parsed: it returns whether the build
/// fills the inside.
void add_attribute_options(const Command& command, AttributeArguments& arguments,
                           const std::string& group, const std::function<bool()>& is_solid);

/// The ids of a mesh's triangles and their names.
struct NamedIds {
  CountedVector<std::uint32_t> ids;  ///< One for each triangle; empty: Mesh::triangle_materials.
  std::vector<std::string> names;
  const char* kind = "material";  ///< "material", "object" or "file".

  TriangleIds view() const {
    return ids.empty() ? TriangleIds{} : TriangleIds{ids, static_cast<std::uint32_t>(names.size())};
  }
};
/// Returns the ids of the triangles of `meshes`, which were read from `files`. Throws Error if
/// there are no ids or more than kMaxMaterials, and OverMemory.
NamedIds named_ids(IdKind kind, const JoinedMeshes& meshes, const std::vector<std::string>& files,
                   MemoryBudget* memory);

/// Builds the attributes of a DAG at the resolution that the arguments ask for, which must pass
/// check_levels(). `shading` may be null if the arguments do not need it; `work` has a budget.
/// `cover` is the surface's DAG if `dag` is that of a solid, else null. Uses metadata.grid and
/// metadata.counts, and sets metadata.attributes. Throws what build_attributes() throws.
DagAttributes build_wanted_attributes(const AttributeArguments& arguments,
                                      const MeshWithAppearance& source, const NamedIds& ids,
                                      const SvdagView& dag, const SvdagView* cover,
                                      const SurfaceShading* shading, VdagMetadata& metadata,
                                      Work work);

}  // namespace voxdag::cli
