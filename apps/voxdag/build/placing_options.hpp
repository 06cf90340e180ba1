#pragma once
/// The options of `voxdag build` and `voxdag import` that say where an input lies and where the
/// grid does.
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag::cli {

/// Adds --snap, --padding and --center.
void add_margin_options(const Command& command, GridRequest& grid);
/// Adds --up, --unit, --scale, --rotate and --translate.
void add_transform_options(const Command& command, TransformRequest& transform);

/// Parses the number of voxels along a side, "1000" or "8K": 1 to 2^kMaxLevels.
std::int64_t parse_resolution(const std::string& text);

/// Returns the lines of a summary that say how the input was moved; empty if it was not.
std::string transform_table(const TransformRequest& transform, const FormatCustom& custom);

/// Returns the files that arguments name: the files with one of `endings` in a folder, by name, and
/// those that match a pattern with * or ?. Other arguments stay as they are.
std::vector<std::string> expand_inputs(const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& endings);
/// Returns the names of the files without their folders: "a.obj, b.glb", or the first of many and
/// how many more there are.
std::string names_of(const std::vector<std::string>& files);

}  // namespace voxdag::cli
