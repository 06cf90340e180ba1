#pragma once
/// `voxdag build --as esvo`.
#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

#include "build/bake_ao.hpp"
#include "build/displace_option.hpp"
#include "cli/session.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/esvo/build/build_esvo.hpp"

namespace voxdag {

struct EsvoArguments {
  EsvoOptions options;
  double normal_degrees = 3;  ///< EsvoSettings::normal_error in degrees.
  DisplaceArguments displace;
  BakeArguments bake;
};

void add_esvo_options(CLI::App& command, EsvoArguments& arguments);

/// The arguments that all kinds of builds share.
struct EsvoBuild {
  std::string output;
  /// Returns the grid for a mesh, or for the bounds of its displaced surface if they are given.
  std::function<Grid(const Mesh&, const std::optional<Box3d>&)> choose_grid;
  std::map<std::string, std::string> settings;  ///< Of the grid, for the metadata.
  std::uint64_t memory_limit = 0;               ///< Bytes; 0: none.
  bool stats = false;
};

/// Reads session.subject with its textures, builds, writes, and prints the summary.
void build_esvo_file(const EsvoArguments& arguments, const EsvoBuild& build, Session& session);

}  // namespace voxdag
