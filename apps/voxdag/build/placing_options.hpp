#pragma once
/// The options of `voxdag build` and `voxdag import` that move the input and place the grid.
#include <string>

#include "cli/command.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag::cli {

/// Adds --snap, --padding and --center.
void add_margin_options(const Command& command, GridRequest& grid);
/// Adds --up, --unit, --scale, --rotate and --translate.
void add_transform_options(const Command& command, TransformRequest& transform);

/// Returns the line of a summary that says how the input was moved; empty if it was not. `custom`
/// is that of the first input.
std::string transform_table(const TransformRequest& transform, const FormatCustom& custom);

}  // namespace voxdag::cli
