#include "lab/reproduce/esvo/esvo_pictures.hpp"

#include <fmt/core.h>

#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

/// The pictures of the paper have no shadows, and no ambient occlusion but what was baked.
const std::vector<std::string> kAsInThePaper{"--no-shadows", "--ao", "0"};

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Returns options of `render` that show a hand of the scan as closely as Figure 10 of the paper
/// shows that of its fairy; of another scene, those that show it well.
std::vector<std::string> hand_of(const FoundScene& scene) {
  if (scene.identity.file_check != kLucyCheck) return view_of(scene);
  return {"--eye", "2230,-2234,1380", "--target", "912,-30,288", "--up",
          "0,0,1", "--fov",           "3.2",      "--sun",       "1,-0.2,0.6"};
}

class EsvoPainter {
 public:
  EsvoPainter(const PapersPlan& plan, CellStore& cells, const Progress& progress)
      : plan_(plan), painter_(plan, cells, progress) {
    const ImageSize size = plan.pictures.size;
    half_ = {size.width / 2, size.height};
  }

  /// Paints Figures 1 and 9.
  void paint_cathedral(const FoundScene& scene) {
    painter_.show(scene, {plan_.esvo.picture_levels, true, {"--bake-ao"}});
    const std::vector<std::string> camera = camera_of(scene);
    pictures.cathedral = {
        painter_.paint("esvo-figure1.png", "", plan_.pictures.size, joined(camera, kAsInThePaper))};
    const std::vector<std::string> options = joined(camera, kAsInThePaper);
    pictures.steps = {
        painter_.paint("esvo-figure9-plain.png", "steps64", half_, joined(options, {"--no-beams"})),
        painter_.paint("esvo-figure9-beams.png", "steps64", half_, options)};
  }

  void paint_contours(const FoundScene& scene) {
    for (const int levels : plan_.esvo.coarse_levels) {
      const auto paint = [&](const char* form, const std::vector<std::string>& options) {
        painter_.show(scene, {levels, true, options});
        return painter_.paint(fmt::format("esvo-figure4-{}-{}.png", 1 << levels, form), "", half_,
                              joined(view_of(scene), {"--no-filter"}));
      };
      pictures.contours.push_back(
          {levels, paint("cubes", {"--no-contours"}), paint("contours", {})});
    }
  }

  /// Paints Figure 10.
  void paint_hand(const FoundScene& scene) {
    show_pruned(scene);
    const std::vector<std::string> options = joined(hand_of(scene), kAsInThePaper);
    pictures.filters = {paint_filtered("esvo-figure10-naive.png", options, "naive"),
                        paint_filtered("esvo-figure10-adaptive.png", options, "plain")};
  }

  /// Paints Figure 11, with the shadows that the paper's pictures do not have.
  void paint_guides(const FoundScene& scene) {
    show_pruned(scene);
    const std::vector<std::string> options = view_of(scene);
    pictures.guides = {paint_filtered("esvo-figure11-plain.png", options, "plain"),
                       paint_filtered("esvo-figure11-guided.png", options, "guided")};
  }

  void paint_scene(const FoundScene& scene) {
    painter_.show(scene, {plan_.esvo.picture_levels, true, {}});
    pictures.scenes.push_back(painter_.paint(fmt::format("esvo-figure12-{}.png", scene.scene->name),
                                             "", plan_.pictures.size, view_of(scene)));
  }

  EsvoPictures pictures;

 private:
  /// Shows few levels of a scene, with wide error bounds, so that neighbouring voxels differ in
  /// size.
  void show_pruned(const FoundScene& scene) {
    painter_.show(scene, {plan_.esvo.filter_levels,
                          true,
                          {"--max-error", "1", "--normal-error", "12", "--color-error", "0.1"}});
  }

  ScenePicture paint_filtered(const std::string& file, const std::vector<std::string>& options,
                              const std::string& kind) {
    return painter_.paint(file, "", half_, joined(options, {"--filter-kind", kind}));
  }

  const PapersPlan& plan_;
  Painter painter_;
  ImageSize half_;
};

/// Paints figures of a scene.
struct PaintFigures {
  const FoundScene* scene;
  void (EsvoPainter::*paint)(const FoundScene& scene);
};

std::vector<PaintFigures> all_figures(const std::vector<FoundScene>& scenes,
                                      const FoundScene& close_up) {
  std::vector<PaintFigures> figures;
  for (const FoundScene& scene : scenes) {
    if (scene.is_absent()) continue;
    if (scene.identity.is_displaced) figures.push_back({&scene, &EsvoPainter::paint_cathedral});
    figures.push_back({&scene, &EsvoPainter::paint_scene});
    if (scene.scene->name == "Sibenik") figures.push_back({&scene, &EsvoPainter::paint_guides});
  }
  if (!close_up.is_absent()) {
    figures.push_back({&close_up, &EsvoPainter::paint_contours});
    figures.push_back({&close_up, &EsvoPainter::paint_hand});
  }
  return figures;
}

Section figure1_section(const EsvoPictures& pictures) {
  Section section{"Figure 1: a displaced cathedral", 2, {}};
  section.parts.emplace_back(Paragraph{
      "As in the paper, the surface is displaced, and ambient occlusion is baked into the colours: "
      "all geometry and shading data is that of the voxels. The picture has no other shadows."});
  for (const ScenePicture& picture : pictures.cathedral)
    add_picture(section, picture, picture.scene.title() + ".");
  return section;
}

Section figure4_section(const EsvoPictures& pictures) {
  Section section{"Figures 4 and 5: contours", 2, {}};
  section.parts.emplace_back(Paragraph{
      "The same grids as cubes and with contours. They are coarse on purpose, and the filter is "
      "off."});
  for (const CubesAndContours& both : pictures.contours)
    add_row(section, {both.cubes, both.contours},
            {fmt::format("Cubes at {}.", short_resolution(both.levels)),
             fmt::format("Contours at {} (the command's).", short_resolution(both.levels))});
  return section;
}

Section figure9_section(const EsvoPictures& pictures) {
  Section section{"Figure 9: steps of the primary rays", 2, {}};
  section.parts.emplace_back(Paragraph{
      "As in the paper, white is 64 steps. The steps of the beams count, spread over their "
      "pixels."});
  add_row(section, pictures.steps, {"Without beams.", "With beams (the command's)."});
  return section;
}

Section figure10_section(const EsvoPictures& pictures) {
  Section section{"Figure 10: the filter", 2, {}};
  section.parts.emplace_back(Paragraph{
      "An octree with few levels and wide error bounds, so that neighbouring voxels differ in "
      "size. The naive filter averages a disc of the pixel's own voxel: seams show where the size "
      "changes, and the background bleeds into outlines. The paper's filter shrinks the disc to "
      "the voxels that it covers."});
  add_row(section, pictures.filters, {"The naive filter.", "The paper's filter (the command's)."});
  return section;
}

Section figure11_section(const EsvoPictures& pictures) {
  Section section{"Figure 11: the paper's filter and guides", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Figure 11 of the paper is the algorithm of its filter. It also averages across the edges of "
      "large voxels and across shadows; the paper's pictures have no shadows. By default `render` "
      "leaves out pixels of other surfaces and in other light."});
  add_row(section, pictures.guides, {"The paper's filter.", "With guides (the command's)."});
  return section;
}

Section figure12_section(const EsvoPictures& pictures) {
  Section section{"Figure 12: the scenes", 2, {}};
  section.parts.emplace_back(
      Paragraph{"Octrees with contours, colours and normals, lit as `render` does by default."});
  for (const ScenePicture& picture : pictures.scenes)
    add_picture(section, picture, picture.scene.title() + ".");
  return section;
}

}  // namespace

EsvoPictures render_esvo_pictures(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                                  const FoundScene& close_up, CellStore& cells,
                                  const Progress& progress) {
  EsvoPainter painter(plan, cells, progress);
  for (const PaintFigures& figures : all_figures(scenes, close_up))
    (painter.*figures.paint)(*figures.scene);
  return std::move(painter.pictures);
}

std::vector<RunItem> esvo_picture_items(const PapersPlan& plan,
                                        const std::vector<FoundScene>& scenes,
                                        const FoundScene& close_up, CellStore& cells,
                                        const Progress& progress) {
  std::vector<RunItem> items;
  for (const PaintFigures& figures : all_figures(scenes, close_up))
    items.push_back([&plan, &cells, &progress, figures, scene = *figures.scene] {
      EsvoPainter painter(plan, cells, progress);
      (painter.*figures.paint)(scene);
    });
  return items;
}

std::vector<Section> esvo_picture_sections(const EsvoPictures& pictures) {
  std::vector<Section> sections;
  if (!pictures.cathedral.empty()) sections.push_back(figure1_section(pictures));
  if (!pictures.contours.empty()) sections.push_back(figure4_section(pictures));
  if (!pictures.steps.empty()) sections.push_back(figure9_section(pictures));
  if (!pictures.filters.empty()) sections.push_back(figure10_section(pictures));
  if (!pictures.guides.empty()) sections.push_back(figure11_section(pictures));
  if (!pictures.scenes.empty()) sections.push_back(figure12_section(pictures));
  return sections;
}

}  // namespace voxdag::lab
