#pragma once
/// `--displace`: height textures that become geometry.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/displace/displaced_triangles.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct DisplaceArguments {
  std::string texture;  ///< A file, or "stone" for the built-in stone wall; empty: the materials'.
  double amount = 0;    ///< World units.
  double scale = 0;     ///< World units that the texture covers; 0: its texture coordinates say.
  bool is_off = false;  ///< Not even the materials' own maps.
};

/// From "TEXTURE:AMOUNT" or "TEXTURE:AMOUNT:SCALE"; the texture's name may have colons itself.
/// Throws std::invalid_argument.
void parse_displace(const std::string& text, DisplaceArguments& arguments);

CLI::Option* add_displace_option(CLI::App& command, DisplaceArguments& arguments);
void add_no_displacement_option(CLI::App& command, DisplaceArguments& arguments);

/// The mesh displaced as asked, or nothing where nothing moves.
std::optional<DisplacedTriangles> open_displaced(const DisplaceArguments& arguments,
                                                 const Mesh& mesh, const Appearance& appearance,
                                                 std::vector<std::string>& warnings,
                                                 Progress& progress,
                                                 MemoryBudget* memory = nullptr);

/// What holds all of the displaced surface.
Box3d displaced_bounds(const DisplacedTriangles& displaced, const Mesh& mesh);

/// As `--displace` takes it, without the texture's folder, or empty.
std::string displace_text(const DisplaceArguments& arguments);

}  // namespace voxdag
