#include "lab/attributes/color_pictures.hpp"

#include "voxdag/cpu/render_image.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag::lab {
namespace {

constexpr int kWidth = 800, kHeight = 600;

/// Returns the luma (Rec. 601) of the bytes of a picture file.
GreyImage luma_of(const RenderedImage& image) {
  GreyImage luma{image.width, image.height, {}};
  luma.values.reserve(image.rgb.size());
  for (const Vec3f pixel : image.rgb)
    luma.values.push_back(0.299 * linear_to_srgb8(pixel.x) + 0.587 * linear_to_srgb8(pixel.y) +
                          0.114 * linear_to_srgb8(pixel.z));
  return luma;
}

}  // namespace

ColorPictures::ColorPictures(const SvdagView& dag, const Grid& grid, int count,
                             const DagAttributesView& original, Progress& progress)
    : dag_(dag),
      grid_(grid),
      scene_(dag_),
      views_(scene_views(dag_, grid, static_cast<double>(kWidth) / kHeight, count)),
      exposures_(views_.size()) {
  for (std::size_t i = 0; i < views_.size(); ++i)
    originals_.push_back(render(i, original, exposures_[i], progress));
}

std::vector<double> ColorPictures::similarities(const DagAttributesView& colored,
                                                Progress& progress) const {
  std::vector<double> result;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    float exposure = exposures_[i];
    result.push_back(ms_ssim(originals_[i], render(i, colored, exposure, progress)));
  }
  return result;
}

/// Renders a view with this exposure; chooses and sets it if it is 0.
GreyImage ColorPictures::render(std::size_t view, const DagAttributesView& colored, float& exposure,
                                Progress& progress) const {
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.view = as_request(views_[view]);
  options.sun_degrees = 0;
  options.occlusion_samples = 0;
  options.exposure = exposure;
  options.look = ColoredDagView{dag_, colored};
  options.with_normal = options.with_occlusion = options.with_shadow = false;
  const RenderedImage image = render_image(scene_, grid_, options, &progress);
  exposure = image.exposure;
  return luma_of(image);
}

}  // namespace voxdag::lab
