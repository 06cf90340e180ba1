#pragma once
/// Pictures of the ESVO paper: Figures 1, 4, 5, 9, 10, 11 and 12.
#include <vector>

#include "lab/reproduce/painter.hpp"
#include "lab/reproduce/run_items.hpp"

namespace voxdag::lab {

/// The same voxels as cubes and with contours.
struct CubesAndContours {
  int levels = 0;
  ScenePicture cubes, contours;
};

struct EsvoPictures {
  std::vector<ScenePicture> cathedral;     ///< Figure 1: one picture, or none.
  std::vector<CubesAndContours> contours;  ///< Figures 4 and 5: coarse grids, ascending.
  std::vector<ScenePicture> steps;         ///< Figure 9: without and with beams; or none.
  std::vector<ScenePicture> filters;       ///< Figure 10: naive, then adaptive; or none.
  std::vector<ScenePicture> guides;        ///< Figure 11: without, then with guides; or none.
  std::vector<ScenePicture> scenes;        ///< Figure 12.
};

/// Renders the pictures into the plan's folder. `close_up`: the scene of Figures 4, 5 and 10.
/// Throws Error and Cancelled.
EsvoPictures render_esvo_pictures(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                  const FoundScene& close_up, CellStore& cells,
                                  const Progress& progress);

/// Returns the pictures of render_esvo_pictures() as items.
std::vector<RunItem> esvo_picture_items(const PapersPlan& plan,
                                        const std::vector<FoundScene>& scenes,
                                        const FoundScene& close_up, CellStore& cells,
                                        const Progress& progress);

/// Returns a section for each figure.
std::vector<Section> esvo_picture_sections(const EsvoPictures& pictures);

}  // namespace voxdag::lab
