#pragma once
/// The arguments of `voxdag build`.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "build/attribute_options.hpp"
#include "build/bake_ao.hpp"
#include "build/displace_option.hpp"
#include "build/placing_options.hpp"
#include "cli/input_files.hpp"
#include "cli/mesh_input.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/formats/presentation.hpp"

namespace voxdag::cli {

struct EsvoArguments {
  EsvoSettings settings;
  double normal_degrees = 3;  ///< EsvoSettings::normal_error in degrees.
  DisplaceArguments displace;
  BakeArguments bake;
};

struct BuildArguments {
  std::vector<std::string> meshes;  ///< Files: folders and patterns are expanded.
  std::string output;
  MeshAccess access;
  GridRequest grid;
  std::string grid_of;  ///< The file whose grid is used; empty: `grid` chooses it.
  BuildMethod method = BuildMethod::kHashConsed;
  std::uint64_t memory_limit = 0;  ///< Bytes; 0: the default.
  bool stats = false;
  bool as_esvo = false;
  AttributeArguments attributes;   ///< For DAGs.
  std::optional<SolidRule> solid;  ///< For DAGs.
  double winding_threshold = 0.5;
  bool by_centre = false;   ///< SolidOptions::by_centre.
  bool compact = false;     ///< Write the compact form.
  std::string work_folder;  ///< For DAGs: where the work of many processes lies; empty: none.
  std::uint64_t parts = 0;  ///< For DAGs: least number of parts; 0: not given.
  EsvoArguments esvo;

  /// Returns the up axis and the unit of the voxels, as far as the first mesh's format says them.
  Presentation presentation() const {
    return presentation_of(access.transform, access.custom_of(meshes.front()));
  }
  /// Returns the line of a summary that says how the meshes were moved; empty if they were not.
  std::string transform_line() const {
    return transform_table(access.transform, access.custom_of(meshes.front()));
  }
};

/// Builds a DAG from the mesh files, writes it, and prints the summary.
void build_dag_file(BuildArguments arguments, Session& session);

/// Builds a DAG in parts, alone or with the other processes of the job; see cluster/parts_job.hpp.
void build_dag_in_parts(const BuildArguments& arguments, Session& session);

/// Builds an ESVO from the mesh files with their textures, writes it, and prints the
/// summary.
void build_esvo_file(const BuildArguments& arguments, Session& session);

/// Returns the grid of the build of a mesh: as `request` chooses it, or that of --grid-of. Throws
/// Error.
inline Grid grid_of_build(const BuildArguments& arguments, const Mesh& mesh,
                          const GridRequest& request) {
  return arguments.grid_of.empty() ? grid_for(mesh, request) : grid_of_file(arguments.grid_of);
}

/// Warns if the bounding box of the mesh reaches out of the grid of --grid-of, but meets it:
/// warn_if_empty() reports meshes that do not.
void warn_of_parts_outside(const BuildArguments& arguments, const Mesh& mesh, const Grid& grid,
                           Session& session);

/// Returns the settings that shape the voxels, for the metadata of the output.
inline std::map<std::string, std::string> build_settings(const BuildArguments& arguments) {
  std::map<std::string, std::string> settings = settings_of(arguments.grid);
  if (!arguments.grid_of.empty()) settings["grid_from"] = settings["scale_from"] = "file";
  if (arguments.solid)
    add_solid_settings({*arguments.solid, arguments.winding_threshold, arguments.by_centre},
                       settings);
  add_settings(arguments.access.transform, settings);
  return settings;
}

}  // namespace voxdag::cli
