#pragma once
/// The options of `voxdag build` for colours, normals and materials on a DAG.
#include <map>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/file/vdag_metadata.hpp"

namespace voxdag::cli {

struct AttributeArguments {
  AttributeOptions options;
  std::optional<int> levels;  ///< log2 of --attribute-resolution.
  std::optional<bool> cut;    ///< Whether --alpha is `cut`.

  bool needs_shading() const { return options.colors || options.normals; }
  bool is_wanted() const { return needs_shading() || options.materials; }
  /// Returns whether voxels that the alpha test removes are not set.
  bool cuts_alpha() const { return cut.value_or(options.colors); }
  /// Throws UsageError if the attributes would be finer than a DAG of `dag_levels`.
  void check_levels(int dag_levels) const;
};

/// By default, attributes have the finest resolution at which they are expected to fit into this
/// many bytes.
inline constexpr std::uint64_t kAttributeBudget = std::uint64_t{4} << 30;

void add_attribute_options(const Command& command, AttributeArguments& arguments,
                           const std::string& group);

/// Throws Error if material ids are wanted, but the mesh has no materials or too many.
void check_materials(const AttributeArguments& arguments, const Mesh& mesh,
                     const std::string& file);

/// Builds the attributes of a DAG at the resolution that the arguments ask for, which must pass
/// check_levels(). `shading` may be null if the arguments do not need it; `work` has a budget. Uses
/// metadata.grid and metadata.counts, and sets metadata.attributes. Throws what build_attributes()
/// throws.
DagAttributes build_wanted_attributes(const AttributeArguments& arguments,
                                      const MeshWithAppearance& source, const SvdagView& dag,
                                      const SurfaceShading* shading, VdagMetadata& metadata,
                                      Work work);

}  // namespace voxdag::cli
