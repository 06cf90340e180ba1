#pragma once
/// Views from inside a scene.
#include <vector>

#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/render/scene_explorer.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// A view from a roomy place inside a scene, in the best direction. Better views have a greater
/// score.
struct InsideView {
  double score = 0;
  View view;
};

/// Returns the best view from each roomy place, best first; no views if there is no such place.
/// `fov` is vertical, in degrees, `aspect` = width / height.
std::vector<InsideView> inside_views(const CoarseCells& scene, const SceneExplorer& explorer,
                                     const Grid& grid, const Compass& compass, double fov,
                                     double aspect);

}  // namespace voxdag
