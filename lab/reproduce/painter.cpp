#include "lab/reproduce/painter.hpp"

#include <fmt/core.h>

#include "lab/reproduce/build_series.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

std::string comma_text(Vec3d v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); }

}  // namespace

std::vector<std::string> camera_of(const FoundScene& scene) {
  const std::optional<ScenePreset> preset = preset_of(scene);
  if (!preset) return {};
  return {"--eye", comma_text(preset->eye), "--target", comma_text(preset->target),
          "--up",  comma_text(preset->up),  "--fov",    fmt::format("{:.6g}", preset->fov_degrees)};
}

std::vector<std::string> view_of(const FoundScene& scene) {
  std::vector<std::string> view = camera_of(scene);
  if (const std::optional<ScenePreset> preset = preset_of(scene))
    view.insert(view.end(), {"--sun", comma_text(preset->sun_direction)});
  return view;
}

Painter::~Painter() { remove_voxels(); }

void Painter::remove_voxels() {
  std::error_code ignored;
  if (!voxels_.empty()) fs::remove(voxels_, ignored);
}

void Painter::show(const FoundScene& scene, const PictureVoxels& voxels) {
  remove_voxels();
  scene_ = scene;
  voxels_ = plan_.scratch / (voxels.is_esvo ? "picture.esvo" : "picture.vdag");
  fs::remove(voxels_);
  std::vector<std::string> options = voxels.options;
  if (voxels.is_esvo) options.insert(options.end(), scene.options.begin(), scene.options.end());
  built_ = cells_.run(build_cell(plan_, scene, voxels.levels, voxels_, options));
}

ScenePicture Painter::paint(const std::string& file, const std::string& pass, ImageSize size,
                            const std::vector<std::string>& options) {
  progress_.throw_if_cancelled();
  ScenePicture picture;
  picture.scene = scene_;
  Cell& cell = picture.cell;
  cell.inputs = {voxels_, scene_.mesh};
  cell.output = plan_.folder / file;
  cell.prints_json = false;
  cell.keeps_output = true;
  cell.arguments = {"render", voxels_, "-q", "--size",
                    fmt::format("{}x{}", size.width, size.height)};
  if (pass.empty())
    cell.arguments.insert(cell.arguments.end(), {"-o", cell.output});
  else
    cell.arguments.insert(cell.arguments.end(),
                          {"--pass", pass + "=" + cell.output.string(), "-o", "picture.png"});
  cell.arguments.insert(cell.arguments.end(), options.begin(), options.end());
  plan_.device.cast(cell);
  picture.result = built_.failure.empty() ? cells_.run(cell) : built_;
  fs::remove(plan_.scratch / "picture.png");
  return picture;
}

void add_picture(Section& section, const ScenePicture& picture, const std::string& caption) {
  if (picture.is_there())
    section.parts.emplace_back(Picture{caption, picture.cell.output.filename()});
  else
    section.parts.emplace_back(
        Paragraph{fmt::format("{} No picture: {}.", caption, picture.result.failure)});
  section.parts.emplace_back(CommandLine{command_of(picture.cell)});
}

void add_row(Section& section, const std::vector<ScenePicture>& pictures,
             const std::vector<std::string>& captions) {
  PictureRow row;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!pictures[i].is_there()) return add_picture(section, pictures[i], captions[i]);
    row.pictures.push_back({captions[i], pictures[i].cell.output.filename()});
  }
  section.parts.emplace_back(std::move(row));
  section.parts.emplace_back(CommandLine{command_of(pictures.back().cell)});
}

}  // namespace voxdag::lab
