#pragma once
/// The option --displace: height textures that become geometry.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"

namespace voxdag::cli {

struct DisplaceArguments {
  std::string texture;  ///< A file, or "stone" (built in); empty: height maps of materials.
  double amount = 0;    ///< World units.
  double scale = 0;     ///< World units that the texture covers; 0: texture coordinates.
  bool is_off = false;  ///< Ignores also the height maps of materials.
};

/// Parses "TEXTURE:AMOUNT" or "TEXTURE:AMOUNT:SCALE"; the name of the texture may contain colons.
/// Throws std::invalid_argument.
void parse_displace(const std::string& text, DisplaceArguments& arguments);

Option add_displace_option(const Command& command, DisplaceArguments& arguments);
Option add_no_displacement_option(const Command& command, DisplaceArguments& arguments);

/// Returns the displaced mesh, or nothing if there is no displacement.
std::optional<DisplacedTriangles> open_displaced(const DisplaceArguments& arguments,
                                                 const Mesh& mesh, const Appearance& appearance,
                                                 std::vector<std::string>& warnings, Work work);

/// Returns the bounding box of the displaced surface.
Box3d displaced_bounds(const DisplacedTriangles& displaced, const Mesh& mesh);

/// Returns the arguments in the form of --displace, without the folder of the texture; empty if
/// there is no displacement.
std::string displace_text(const DisplaceArguments& arguments);

}  // namespace voxdag::cli
