#include "lab/reproduce/svdag/svdag_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/image/decode.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// Sets the difference picture and its error.
void compare(OcclusionPictures& pictures) {
  const DecodedImage exact = read_image(pictures.exact.cell.output),
                     cones = read_image(pictures.cones.cell.output);
  const int width = exact.width(), height = exact.height();
  ImageRgb8 difference(width, height);
  double sum = 0, squares = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // The passes are grey: all channels are equal.
      const auto value = [&](const DecodedImage& image) {
        return image.row(
            y)[static_cast<std::size_t>(x) * static_cast<std::size_t>(image.channels())];
      };
      const double d = (value(cones) - value(exact)) / 255.0;
      sum += d;
      squares += d * d;
      const auto code =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(0.75 + d, 0.0, 1.0)));
      std::fill_n(difference.pixel(x, y), 3, code);
    }
  const double count = static_cast<double>(width) * height;
  pictures.mean_difference = sum / count;
  pictures.root_mean_square = std::sqrt(squares / count);
  write_png(pictures.difference, difference);
}

/// Adds the picture of a scene and, if they are missing and wanted, those of the occlusion in it.
void paint_scene(const PapersPlan& plan, const FoundScene& scene, bool with_occlusion,
                 Painter& painter, SvdagPictures& pictures) {
  painter.show(scene, {plan.pictures.levels, false, {}});
  const std::vector<std::string> view = view_of(scene);
  const auto paint = [&](const std::string& file, const std::string& pass,
                         std::vector<std::string> options) {
    options.insert(options.begin(), view.begin(), view.end());
    return painter.paint(file, pass, plan.pictures.size, options);
  };
  pictures.scenes.push_back(paint(fmt::format("svdag-figure4-{}.png", scene.scene->name), "",
                                  {"--mesh", scene.mesh, "--sun-angle", "2"}));
  if (!with_occlusion || pictures.occlusion || !pictures.scenes.back().is_there()) return;
  OcclusionPictures occlusion;
  occlusion.exact = paint("svdag-figure8b-exact.png", "occlusion", {"--lod", "0"});
  occlusion.cones =
      paint("svdag-figure8b-cones.png", "occlusion", {"--lod", "0", "--ao-cone", "0.07"});
  if (!occlusion.exact.is_there() || !occlusion.cones.is_there()) return;
  occlusion.difference = plan.folder / "svdag-figure8b-difference.png";
  compare(occlusion);
  pictures.occlusion = std::move(occlusion);
}

}  // namespace

SvdagPictures render_pictures(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                              CellStore& cells, Progress& progress) {
  SvdagPictures pictures;
  Painter painter(plan, cells, progress);
  for (const FoundScene& scene : scenes)
    if (!scene.is_absent()) paint_scene(plan, scene, true, painter, pictures);
  return pictures;
}

std::vector<RunItem> picture_items(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                   CellStore& cells, Progress& progress) {
  std::vector<RunItem> items;
  for (const FoundScene& scene : scenes) {
    if (scene.is_absent()) continue;
    const bool is_first = items.empty();
    items.push_back([&plan, &scene, &cells, &progress, is_first] {
      Painter painter(plan, cells, progress);
      SvdagPictures pictures;
      paint_scene(plan, scene, is_first, painter, pictures);
    });
  }
  return items;
}

Section figure4_section(const SvdagPictures& pictures) {
  Section section{"Figure 4: the scenes", 2, {}};
  section.parts.emplace_back(Paragraph{
      "As in the paper, the triangles are shaded, and rays through the DAG find soft shadows and "
      "ambient occlusion."});
  for (const ScenePicture& picture : pictures.scenes)
    add_picture(section, picture, picture.scene.title() + ".");
  return section;
}

Section figure8b_section(const SvdagPictures& pictures) {
  Section section{"Figure 8b: ambient occlusion that ends at a solid angle", 2, {}};
  if (!pictures.occlusion) {
    section.parts.emplace_back(Paragraph{"Not measured: no scene has a picture."});
    return section;
  }
  const OcclusionPictures& both = *pictures.occlusion;
  section.parts.emplace_back(Paragraph{fmt::format(
      "64 rays per pixel in {}, once to voxels and once to the first cell of 0.07 steradians. "
      "The paper says that this darkens the picture but keeps occlusion near contacts. With cones, "
      "{:.1f} % less of the sky's light arrives on average; the root mean square of the difference "
      "is {:.1f} % of the sky's light.",
      both.exact.scene.scene->name, -100 * both.mean_difference, 100 * both.root_mean_square)});
  add_row(section, {both.exact, both.cones},
          {"Rays to voxels.", "Rays to cells of 0.07 steradians (the command's)."});
  section.parts.emplace_back(
      Picture{"The difference: light grey where both are equal, darker where cones are darker.",
              both.difference.filename()});
  return section;
}

}  // namespace voxdag::lab
