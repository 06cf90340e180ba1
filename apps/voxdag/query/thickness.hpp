#pragma once
/// `voxdag query --thickness`.
#include <optional>
#include <string>

#include "cli/length.hpp"
#include "cli/session.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/file/model/scene_model.hpp"

namespace voxdag::cli {

struct ThicknessArguments {
  bool is_asked = false;
  std::optional<Length> thinner;
};

/// Prints the least, the greatest and the mean thickness of the voxels, and how many are thinner
/// than a limit; as JSON also a histogram. With an `output`, writes the thickness of each place of
/// `window` or of the grid, or, if there is a limit, the voxels that are thinner. Throws Error and
/// Cancelled.
void answer_thickness(const ThicknessArguments& arguments, const std::string& output,
                      const std::optional<Box3i>& window, const DagModel& file,
                      MemoryBudget& memory, Session& session);

}  // namespace voxdag::cli
