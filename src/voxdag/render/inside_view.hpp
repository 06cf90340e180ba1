#pragma once
/// Views from inside of a scene.
#include <vector>

#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/render/scene_explorer.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// The best direction at a roomy place inside of a scene. Better views have a greater score.
struct InsideView {
  double score = 0;
  View view;
};

/// Returns the best view of each roomy place, best first; none if there is no roomy place.
/// `fov` is vertical, in degrees, `aspect` = width / height.
std::vector<InsideView> inside_views(const CoarseCells& scene, const SceneExplorer& explorer,
                                     const Grid& grid, const Compass& compass, double fov,
                                     double aspect);

}  // namespace voxdag
