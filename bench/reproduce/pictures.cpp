#include "bench/reproduce/pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/papers/camera_paths.hpp"
#include "bench/reproduce/build_series.hpp"
#include "bench/reproduce/table_text.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/image/decode.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

std::string comma_text(Vec3d v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); }

std::vector<std::string> view_text(Vec3d eye, Vec3d target, Vec3d up, Vec3d sun, double fov) {
  return {"--eye", comma_text(eye), "--target", comma_text(target),        "--up", comma_text(up),
          "--sun", comma_text(sun), "--fov",    fmt::format("{:.6g}", fov)};
}

/// Returns options of `render` that show the scene well; none if nothing is known about it.
std::vector<std::string> view_of(const FoundScene& scene) {
  if (const SceneFlight* flight = flight_of(scene.identity.file_check)) {
    const SceneKey& key = flight->keys.front();
    return view_text(key.eye, key.target, flight->up, flight->sun_direction, flight->fov_degrees);
  }
  if (!scene.identity.is_procedural) return {};
  const ScenePreset preset = scene_preset(scene.identity.name);
  return view_text(preset.eye, preset.target, preset.up, preset.sun_direction, preset.fov_degrees);
}

class Painter {
 public:
  Painter(const PapersPlan& plan, CellStore& cells, Progress& progress)
      : plan_(plan), cells_(cells), progress_(progress) {}

  /// Builds the scene that the next pictures show, if it is not built yet.
  void show(const FoundScene& scene) {
    scene_ = scene;
    dag_ = plan_.folder / "picture.vdag";
    fs::remove(dag_);
    built_ = cells_.run(build_cell(plan_, scene.mesh, plan_.pictures.levels, dag_, {}));
  }
  void done() { fs::remove(dag_); }

  /// Renders a picture to `file` in the plan's folder. If `pass` is not empty, `file` gets that
  /// pass.
  ScenePicture paint(const std::string& file, const std::string& pass,
                     const std::vector<std::string>& options) {
    progress_.throw_if_cancelled();
    ScenePicture picture;
    picture.scene = scene_;
    Cell& cell = picture.cell;
    cell.inputs = {dag_, scene_.mesh};
    cell.output = plan_.folder / file;
    cell.prints_json = false;
    cell.keeps_output = true;
    const ImageSize size = plan_.pictures.size;
    cell.arguments = {"render", dag_, "-q", "--size",
                      fmt::format("{}x{}", size.width, size.height)};
    if (pass.empty())
      cell.arguments.insert(cell.arguments.end(), {"-o", cell.output});
    else
      cell.arguments.insert(cell.arguments.end(),
                            {"--pass", pass + "=" + cell.output.string(), "-o", "../picture.png"});
    const std::vector<std::string> view = view_of(scene_);
    cell.arguments.insert(cell.arguments.end(), view.begin(), view.end());
    cell.arguments.insert(cell.arguments.end(), options.begin(), options.end());
    picture.result = built_.failure.empty() ? cells_.run(cell) : built_;
    fs::remove(plan_.folder / "picture.png");
    return picture;
  }

 private:
  const PapersPlan& plan_;
  CellStore& cells_;
  Progress& progress_;
  FoundScene scene_;
  fs::path dag_;
  CellResult built_;
};

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

}  // namespace

SvdagPictures render_pictures(const PapersPlan& plan, const std::vector<FoundScene>& scenes,
                              CellStore& cells, Progress& progress) {
  SvdagPictures pictures;
  Painter painter(plan, cells, progress);
  for (const FoundScene& scene : scenes) {
    if (scene.is_absent()) continue;
    painter.show(scene);
    const std::string name(scene.scene->name);
    pictures.scenes.push_back(
        painter.paint("figure4-" + name + ".png", "", {"--mesh", scene.mesh, "--sun-angle", "2"}));
    if (pictures.occlusion || !pictures.scenes.back().result.failure.empty()) continue;
    OcclusionPictures occlusion;
    occlusion.exact = painter.paint("figure8b-exact.png", "occlusion", {"--lod", "0"});
    occlusion.cones =
        painter.paint("figure8b-cones.png", "occlusion", {"--lod", "0", "--ao-cone", "0.07"});
    if (!occlusion.exact.result.failure.empty() || !occlusion.cones.result.failure.empty())
      continue;
    occlusion.difference = plan.folder / "figure8b-difference.png";
    compare(occlusion);
    pictures.occlusion = std::move(occlusion);
  }
  painter.done();
  return pictures;
}

Section figure4_section(const SvdagPictures& pictures) {
  Section section{"Figure 4: the scenes", 2, {}};
  section.parts.emplace_back(Paragraph{
      "As in the paper, the triangles are shaded, and rays through the DAG find soft shadows and "
      "ambient occlusion."});
  for (const ScenePicture& picture : pictures.scenes) {
    const std::string title =
        fmt::format("{} ({}).", picture.scene.scene->name, picture.scene.state());
    if (picture.result.failure.empty())
      section.parts.emplace_back(Picture{title, picture.cell.output.filename()});
    else
      section.parts.emplace_back(
          Paragraph{fmt::format("{} No picture: {}.", title, picture.result.failure)});
    section.parts.emplace_back(CommandLine{command_of(picture.cell)});
  }
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
  section.parts.emplace_back(Picture{"Rays to voxels.", both.exact.cell.output.filename()});
  section.parts.emplace_back(CommandLine{command_of(both.exact.cell)});
  section.parts.emplace_back(
      Picture{"Rays to cells of 0.07 steradians.", both.cones.cell.output.filename()});
  section.parts.emplace_back(CommandLine{command_of(both.cones.cell)});
  section.parts.emplace_back(
      Picture{"The difference: light grey where both are equal, darker where cones are darker.",
              both.difference.filename()});
  return section;
}

}  // namespace voxdag
