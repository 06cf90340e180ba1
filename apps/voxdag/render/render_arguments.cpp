#include "render/render_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/environment_input.hpp"
#include "cli/output_files.hpp"
#include "render/film_file.hpp"
#include "voxdag/render/film/camera_file.hpp"
#include "voxdag/render/film/frame_names.hpp"
#include "voxdag/render/film/view_settings.hpp"

namespace voxdag::cli {
namespace {

/// Throws UsageError if a film's file name has no placeholder, or if the name of a single picture
/// has one.
void check_frame_pattern(const OutputFile& output, bool is_film) {
  const auto refuse = [&](const std::string& reason) {
    throw UsageError(output.option, fmt::format("\"{}\" {}", output.path, reason));
  };
  const std::string fault = frame_pattern_fault(output.path);
  if (is_film && !fault.empty()) refuse(fault);
  if (!is_film && fault.empty())
    refuse("has a placeholder for the frame number, which only --path fills in");
}

/// Throws UsageError if no film can be made with these arguments.
void check_film(const RenderArguments& arguments) {
  const std::string& film = arguments.output;
  const auto refuse = [](const char* option, const std::string& reason) {
    throw UsageError(option, reason);
  };
  if (arguments.path.file.empty())
    refuse("--output", fmt::format("\"{}\" is a film, which needs --path", film));
  if (film.find('%') != film.npos)
    refuse("--output", fmt::format("\"{}\" is one film, whose name has no %", film));
  if (arguments.size.width % 2 != 0 || arguments.size.height % 2 != 0)
    refuse("--size", "must be even numbers for a film");
}

std::vector<OutputFile> pictures_of(const RenderArguments& arguments) {
  std::vector<OutputFile> outputs = {{"--output", arguments.output}};
  if (!arguments.depth.empty()) outputs.push_back({"--depth", arguments.depth});
  if (!arguments.normal.empty()) outputs.push_back({"--normal", arguments.normal});
  for (const PicturePass& pass : arguments.passes)
    outputs.push_back({fmt::format("--pass {}", pass.kind->name), pass.path});
  return outputs;
}

/// Returns all outputs. Throws UsageError if a name is wrong or two names conflict.
std::vector<OutputFile> check_outputs(const RenderArguments& arguments, const Session& session) {
  std::vector<OutputFile> outputs = pictures_of(arguments);
  for (const OutputFile& output : outputs) {
    if (output.option == "--output" && is_film_path(output.path)) {
      check_film(arguments);
      continue;
    }
    const bool is_png_anyway = output.option == "--output" && is_standard_output(output.path);
    if (!is_picture_path(output.path) && !is_png_anyway)
      throw UsageError(output.option,
                       fmt::format("\"{}\" does not end in .png or .exr{}", output.path,
                                   output.option == "--output" ? ", or .mp4 or .webm" : ""));
    check_frame_pattern(output, !arguments.path.file.empty());
  }
  if (!arguments.write_camera.empty())
    outputs.push_back({"--write-camera", arguments.write_camera});
  if (!arguments.path.timings.empty()) outputs.push_back({"--timings", arguments.path.timings});
  check_distinct(outputs, session);
  return outputs;
}

/// Throws UsageError for a view that cannot be shown.
void check_view(const ViewRequest& view) {
  if (!view.eye || !view.target) return;
  if (*view.eye == *view.target) throw UsageError("--target", "is the same point as --eye");
  const Vec3d forward = *view.target - *view.eye;
  const double length2 = dot(forward, forward);
  if (!(length2 > 0) || !std::isfinite(length2))
    throw UsageError("--target", length2 > 0 ? "is too far from --eye" : "is too close to --eye");
  if (!view.up) return;
  const Vec3d aside = cross(normalized(forward), normalized(*view.up));
  if (!(dot(aside, aside) > 1e-12)) throw UsageError("--up", "points along the view");
}

}  // namespace

void check_render_arguments(RenderArguments& arguments, Session& session) {
  session.inputs = {arguments.mesh.file, arguments.path.file, arguments.look, arguments.view.file,
                    arguments.camera_matrix};
  note_environment_file(arguments.environment, session);
  if (arguments.mesh.primary == "mesh" && arguments.mesh.file.empty())
    throw UsageError("--primary", "\"mesh\" needs --mesh");
  if (arguments.output.empty() && !arguments.path.file.empty())
    throw UsageError("--output", "is required with --path");
  if (arguments.output.empty())
    arguments.output = default_output(session.subject, session.subject, ".png");
  arguments.mesh.access.outputs = check_outputs(arguments, session);
  check_view(arguments.options.view);
  constexpr std::size_t kMaxLights = RenderSetup::kMaxLights - 1;  // without the sun
  if (arguments.options.lights.size() > kMaxLights)
    throw UsageError("--light", fmt::format("is given {} times; at most {} are allowed",
                                            arguments.options.lights.size(), kMaxLights));
}

void read_render_files(RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  if (!arguments.environment.empty()) options.environment = read_environment(arguments.environment);
  if (arguments.camera_matrix.empty()) return;
  const ViewRequest camera = read_camera_file(arguments.camera_matrix);
  options.view.eye = camera.eye;
  options.view.target = camera.target;
  options.view.up = camera.up;
  options.view.vertical_fov_degrees = camera.vertical_fov_degrees;
}

bool ViewFileArguments::has(const std::string& option) const {
  return std::any_of(winners.begin(), winners.end(), [&](const Option& winner) {
    return winner.name() == option && winner.is_given();
  });
}

void apply_view_file(RenderArguments& arguments, Session& session) {
  ViewFileArguments& view = arguments.view;
  if (view.file.empty()) return;
  const ViewSettings settings = read_view_settings(view.file);
  RenderOptions& options = arguments.options;
  const RenderOptions& saved = settings.options;
  const auto take = [&](const char* option, auto& value, const auto& from_file) {
    if (!view.has(option)) value = from_file;
  };
  // The views of a film come from its camera path.
  if (arguments.path.file.empty()) {
    take("--eye", options.view.eye, saved.view.eye);
    take("--target", options.view.target, saved.view.target);
    take("--up", options.view.up, saved.view.up);
    take("--fov", options.view.vertical_fov_degrees, saved.view.vertical_fov_degrees);
  }
  take("--sun", options.sun, saved.sun);
  take("--sun-angle", options.sun_degrees, saved.sun_degrees);
  // An option that describes the sun also turns it on.
  if (!view.has("--sun") && !view.has("--sun-angle"))
    take("--no-sun", options.with_sun, saved.with_sun);
  take("--sky", options.sky, saved.sky);
  options.environment = saved.environment;  // --environment, which is read later, wins.
  take("--environment-turn", options.environment_degrees, saved.environment_degrees);
  take("--bounces", options.bounces, saved.bounces);
  take("--no-shadows", options.shadows, saved.shadows);
  take("--exposure", options.exposure, saved.exposure);
  take("--tone", options.tone, saved.tone);
  take("--background", options.background, saved.background);
  take("--ground", options.ground, saved.ground);
  take("--ao", options.occlusion_samples, saved.occlusion_samples);
  take("--ao-distance", options.occlusion_distance, saved.occlusion_distance);
  take("--ao-cone", options.occlusion_cone, saved.occlusion_cone);
  take("--lod", options.lod_pixels, saved.lod_pixels);
  take("--section-box", options.section.box, saved.section.box);
  take("--section-plane", options.section.plane, saved.section.plane);
  options.section.hatch = saved.section.hatch;
  take("--cubes", options.cube_pixels, saved.cube_pixels);
  if (!arguments.mesh.file.empty() && (options.section.box || options.section.plane))
    throw Error(view.file, "", "\"section\" cannot cut the triangles of --mesh: set it to null");
  view.colors = settings.colors;
  view.normals = settings.normals;
  std::vector<std::string> warnings;
  for (const std::string& text : settings.ignored) warnings.push_back(view.file + ": " + text);
  if (arguments.channel.empty() && !arguments.materials && !settings.channel.empty()) {
    if (arguments.mesh.is_seen() || arguments.stream_memory != 0) {
      warnings.push_back(view.file + ": \"channel\" is ignored: " +
                         (arguments.mesh.is_seen() ? "--mesh" : "--memory") + " shows no channels");
    } else {
      arguments.channel = settings.channel;
      arguments.channel_range = settings.channel_range;
    }
  }
  print_warnings(warnings, session);
}

std::vector<PicturePass> all_passes(const RenderArguments& arguments) {
  std::vector<PicturePass> passes = {{find_picture_kind("picture"), arguments.output}};
  if (!arguments.depth.empty()) passes.push_back({find_picture_kind("depth"), arguments.depth});
  if (!arguments.normal.empty()) passes.push_back({find_picture_kind("normal"), arguments.normal});
  passes.insert(passes.end(), arguments.passes.begin(), arguments.passes.end());
  return passes;
}

RenderOptions picture_options(const RenderArguments& arguments, bool is_esvo) {
  RenderOptions options = arguments.options;
  options.width = arguments.size.width;
  options.height = arguments.size.height;
  options.filter = arguments.filter_kind;
  const bool is_usual = arguments.filter || (is_esvo && !arguments.no_filter);
  if (options.filter == FilterKind::kNone && is_usual) options.filter = FilterKind::kGuided;
  options.with_normal = options.with_occlusion = options.with_shadow = false;
  for (const PicturePass& pass : all_passes(arguments))
    if (pass.kind->needs != nullptr) options.*(pass.kind->needs) = true;
  return options;
}

}  // namespace voxdag::cli
