#include "lab/reproduce/svdag/svdag_figure1.hpp"

#include <fmt/core.h>

#include <cmath>

#include "lab/papers/camera_paths.hpp"
#include "lab/papers/svdag_published.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the scene of the figure, or null.
const FoundScene* scene_of_figure(const std::vector<FoundScene>& scenes) {
  const FoundScene* best = nullptr;
  for (const FoundScene& scene : scenes) {
    if (scene.is_absent() || !preset_of(scene)) continue;
    const bool is_better =
        best == nullptr || scene.match.state < best->match.state ||
        (scene.match.state == best->match.state && scene.scene->name == published::kFigure1.scene);
    if (is_better) best = &scene;
  }
  return best;
}

/// Returns the path that stays at the view of the scene's picture.
std::string path_at_view(const FoundScene& scene) {
  ScenePreset preset = *preset_of(scene);
  preset.flight = {{0, preset.eye, preset.target}};
  return path_json(path_file(preset));
}

/// Returns "12.3 M"; "–" if the rays were not measured.
std::string rate_text(const FlightRun& run, const char* rays) {
  const double millions = mrays_per_second(run, rays);
  return std::isnan(millions) ? "–" : count_text(1e6 * millions);
}

}  // namespace

std::optional<SvdagFigure1> measure_figure1(const PapersPlan& plan,
                                            const std::vector<FoundScene>& scenes, CellStore& cells,
                                            const Progress& progress) {
  const FoundScene* scene = scene_of_figure(scenes);
  if (scene == nullptr) return std::nullopt;
  SvdagFigure1 figure;
  Painter painter(plan, cells, progress);
  painter.show(*scene, {plan.figure1_levels, false, {}});
  figure.build = painter.built();
  std::vector<std::string> options = view_of(*scene);
  options.insert(options.end(), {"--mesh", scene->mesh});
  figure.picture = painter.paint("svdag-figure1.png", "", plan.pictures.size, options);
  const CameraPathFile path(plan.folder / "view.json", path_at_view(*scene), cells);
  figure.rays = trace_path(plan, *scene, {painter.voxels(), plan.figure1_levels}, path, 1, {});
  if (figure.build.failure.empty())
    measure(figure.rays, cells);
  else
    figure.rays.result.failure = figure.build.failure;
  return figure;
}

Section figure1_section(const SvdagFigure1& figure) {
  Section section{"Figure 1: the finest grid", 2, {}};
  const FoundScene& scene = figure.picture.scene;
  const auto& paper = published::kFigure1;
  section.parts.emplace_back(Paragraph{fmt::format(
      "The triangles are shaded, and rays through the DAG find shadows and ambient occlusion. The "
      "paper's picture shows {}, and its rates are those of a {}: they say what the paper did, and "
      "do not compare with ours.",
      paper.scene, paper.device)});
  Table table{"", {"", scene.title(), fmt::format("published: {}", paper.scene)}, {}};
  table.caption = "The scene of Figure 1 and the rays of its picture";
  const auto add = [&](const char* what, std::string ours, std::string published) {
    table.rows.push_back({what, std::move(ours), std::move(published)});
  };
  if (figure.build.failure.empty()) {
    const Json& json = figure.build.json;
    const auto bytes = [&](const char* kind) { return json.at("bytes").at(kind).get<double>(); };
    add("resolution", short_resolution(figure.rays.levels), short_resolution(paper.levels));
    add("voxels", count_text(json.at("voxels")), count_text(paper.voxels));
    add("DAG (MB)", number_text(bytes("svdag_paper") / (1 << 20)),
        number_text(paper.dag_megabytes));
    add("octree without pointers (MB)", number_text(bytes("svo_pointerless") / (1 << 20)),
        number_text(paper.svo_megabytes));
    add("build", seconds_text(figure.build.cost.wall_seconds), "–");
    add("memory of the build (MB)",
        number_text(static_cast<double>(figure.build.cost.peak_bytes) / (1 << 20)), "–");
  }
  add("shadow rays per second", rate_text(figure.rays, "shadow"),
      count_text(paper.shadow_rays_per_second));
  add("occlusion rays per second", rate_text(figure.rays, "ao"),
      count_text(paper.occlusion_rays_per_second));
  section.parts.emplace_back(std::move(table));
  add_picture(section, figure.picture, scene.title() + ", lit through its DAG.");
  section.parts.emplace_back(CommandLine{command_of(figure.rays.cell)});
  return section;
}

Json figure1_json(const SvdagFigure1& figure) {
  return {{"scene", std::string(figure.picture.scene.scene->name)},
          {"state", figure.picture.scene.state()},
          {"build", figure.build.failure.empty() ? figure.build.json : Json(figure.build.failure)},
          {"picture", command_of(figure.picture.cell)},
          {"rays", run_json(figure.rays)}};
}

}  // namespace voxdag::lab
