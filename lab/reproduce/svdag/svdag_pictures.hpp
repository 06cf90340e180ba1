#pragma once
/// Pictures of the SVDAG paper: Figure 4, the scenes, and Figure 8b, ambient occlusion with and
/// without cones.
#include <optional>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/painter.hpp"
#include "lab/reproduce/run_items.hpp"

namespace voxdag::lab {

/// Ambient occlusion of one view with rays to voxels and with rays that end at cells of 0.07 sr.
struct OcclusionPictures {
  ScenePicture exact, cones;
  std::filesystem::path difference;  ///< Grey where both are equal, darker where cones are darker.
  double mean_difference = 0;        ///< Cones minus exact, in parts of the sky's light.
  double root_mean_square = 0;       ///< Of the differences.
};

struct SvdagPictures {
  std::vector<ScenePicture> scenes;
  std::optional<OcclusionPictures> occlusion;  ///< Of the first scene that has a picture.
};

/// Renders the pictures into the plan's folder. Throws Error and Cancelled.
SvdagPictures render_pictures(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                              CellStore& cells, Progress& progress);

/// Returns the pictures of each scene as an item.
std::vector<RunItem> picture_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                   CellStore& cells, Progress& progress);

Section figure4_section(const SvdagPictures& pictures);
Section figure8b_section(const SvdagPictures& pictures);

}  // namespace voxdag::lab
