#pragma once
/// Compares pictures of a DAG with exact colours and with stored ones.
#include <memory>
#include <vector>

#include "lab/attributes/ms_ssim.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/render/view.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag::lab {

/// Renders the same views of a DAG with different colours: 800×600 pixels, a sun with hard shadows,
/// a sky without occlusion. Rays end at cells as small as a pixel, as in `voxdag render`.
class ColorPictures {
 public:
  /// Chooses `count` views with scene_views(), and renders them with the colours `original`, which
  /// may change after. Points to the dag, which must outlive it. Throws Cancelled.
  ColorPictures(const SvdagView& dag, const Grid& grid, int count,
                const DagAttributesView& original, Progress& progress);

  /// Returns for each view the MS-SSIM of the luma with these colours and with the original ones.
  /// Throws Cancelled.
  std::vector<double> similarities(const DagAttributesView& colored, Progress& progress) const;

 private:
  GreyImage render(std::size_t view, const DagAttributesView& colored, float& exposure,
                   Progress& progress) const;

  SvdagView dag_;
  Grid grid_;
  CpuScene scene_;
  std::vector<View> views_;
  std::vector<float> exposures_;
  std::vector<GreyImage> originals_;
};

}  // namespace voxdag::lab
