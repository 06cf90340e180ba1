#pragma once
/// The arguments of `voxdag build`.
#include <map>
#include <optional>
#include <string>

#include "build/attribute_options.hpp"
#include "build/bake_ao.hpp"
#include "build/displace_option.hpp"
#include "cli/mesh_input.hpp"
#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/esvo/build/build_esvo.hpp"
#include "voxdag/solid/fill_solid.hpp"

namespace voxdag {

struct EsvoArguments {
  EsvoSettings settings;
  double normal_degrees = 3;  ///< EsvoSettings::normal_error in degrees.
  DisplaceArguments displace;
  BakeArguments bake;
};

struct BuildArguments {
  std::string output;
  MeshAccess access;
  std::optional<int> levels;  ///< Either this or voxel_size.
  std::optional<double> voxel_size;
  std::optional<Box3d> bounds;
  BuildMethod method = BuildMethod::kHashConsed;
  std::uint64_t memory_limit = 0;  ///< Bytes; 0: the default.
  bool stats = false;
  bool as_esvo = false;
  AttributeArguments attributes;   ///< For DAGs.
  std::optional<SolidRule> solid;  ///< For DAGs.
  double winding_threshold = 0.5;
  bool compact = false;  ///< Write the compact form.
  EsvoArguments esvo;
};

/// Returns the grid that the arguments ask for. `surface` is the bounding box of the displaced
/// surface, if there is displacement.
Grid choose_grid(const Mesh& mesh, const std::optional<Box3d>& surface,
                 const BuildArguments& arguments);

/// The names of the rules in options and metadata. solid_rule() throws std::invalid_argument.
std::string name_of(SolidRule rule);
SolidRule solid_rule(const std::string& name);
/// Returns what settings of metadata, which must have "solid", say. Throws std::invalid_argument.
SolidOptions solid_options(const std::map<std::string, std::string>& settings);

/// Returns the settings that shape the voxels, for the metadata of the output.
std::map<std::string, std::string> grid_settings(const BuildArguments& arguments);

/// Builds a DAG from the mesh file session.subject, writes it, and prints the summary.
void build_dag_file(const BuildArguments& arguments, Session& session);

/// Builds an ESVO from the mesh file session.subject with its textures, writes it, and prints the
/// summary.
void build_esvo_file(const BuildArguments& arguments, Session& session);

}  // namespace voxdag
