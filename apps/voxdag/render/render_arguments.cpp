#include "render/render_arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "cli/commands.hpp"
#include "cli/number_check.hpp"
#include "cli/output_files.hpp"
#include "render/render_light.hpp"

namespace voxdag {
namespace {

/// Throws CLI::ValidationError for names of outputs that are wrong, alone or together.
void check_outputs(const RenderArguments& arguments, const Session& session) {
  std::vector<OutputFile> outputs = {{"--output", arguments.output}};
  if (!arguments.depth.empty()) outputs.push_back({"--depth", arguments.depth});
  if (!arguments.normal.empty()) outputs.push_back({"--normal", arguments.normal});
  for (const RenderPass& pass : arguments.passes)
    outputs.push_back({"--pass " + pass.name, pass.path});
  for (const OutputFile& output : outputs) {
    try {
      check_picture_path(output.path);
    } catch (const std::invalid_argument& wrong) {
      throw CLI::ValidationError(output.option, wrong.what());
    }
    check_frame_pattern(output, arguments.path);
  }
  if (!arguments.path.timings.empty()) {
    outputs.push_back({"--timings", arguments.path.timings});
    outputs.push_back({"the plot of --timings", timings_plot(arguments.path.timings)});
  }
  check_distinct(outputs, session);
}

/// Throws CLI::ValidationError for a view that no scene has.
void check_view(const ViewRequest& view) {
  if (!view.eye || !view.target) return;
  const Vec3d forward = *view.target - *view.eye;
  if (!(dot(forward, forward) > 0))
    throw CLI::ValidationError("--target", "is the same point as --eye");
  if (!view.up) return;
  const Vec3d aside = cross(normalized(forward), normalized(*view.up));
  if (!(dot(aside, aside) > 1e-12)) throw CLI::ValidationError("--up", "points along the view");
}

/// An option that may be given several times; each text becomes one value.
template <class Value>
void add_list_option(CLI::App& command, const std::string& name, std::vector<Value>& values,
                     Value (*parse)(const std::string&), const std::string& shape,
                     const std::string& help) {
  const auto store = [&values, parse, name](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      try {
        values.push_back(parse(text));
      } catch (const std::invalid_argument& wrong) {
        throw CLI::ValidationError(name, fmt::format("\"{}\": {}", text, wrong.what()));
      }
    }
  };
  command.add_option_function<std::vector<std::string>>(name, store, help)
      ->type_name(shape)
      ->allow_extra_args(false);
}

/// A flag that makes `value` false.
void add_off_switch(CLI::App& command, const std::string& name, bool& value,
                    const std::string& help) {
  command.add_flag_callback(
      name, [&value] { value = false; }, help);
}

void add_view_options(CLI::App& command, ViewRequest& view) {
  add_parsed_option(command, "--eye", view.eye, parse_vec3, "X,Y,Z",
                    "Where the camera is (default: where the scene shows well)");
  add_parsed_option(command, "--target", view.target, parse_vec3, "X,Y,Z",
                    "The point in the middle of the picture");
  add_parsed_option(command, "--up", view.up, parse_direction, "X,Y,Z",
                    "What is up (default: y, or z where the scene rests on it)");
  command.add_option("--fov", view.vertical_fov_degrees, "Vertical angle of view")
      ->check(number_between(0, 180))
      ->type_name("DEGREES");
}

void add_light_options(CLI::App& command, RenderOptions& options) {
  add_parsed_option(command, "--sun", options.sun, parse_direction, "X,Y,Z",
                    "Direction towards the sun (default: over the viewer's left shoulder)");
  command.add_option("--sun-angle", options.sun_degrees, "The sun's angle across; 0: hard shadows")
      ->check(number_from(0, 89))
      ->type_name("DEGREES")
      ->capture_default_str();
  add_off_switch(command, "--no-sun", options.with_sun, "Leave the sun out");
  add_list_option(command, "--light", options.lights, parse_light, "KIND:...",
                  "A light: point:X,Y,Z, sphere:X,Y,Z,RADIUS, disc:X,Y,Z,NX,NY,NZ,RADIUS or "
                  "rect:X,Y,Z,UX,UY,UZ,VX,VY,VZ, and ,R,G,B for its colour; may be repeated");
  command.add_option("--sky", options.sky, "Factor on the sky's light; 0: black")
      ->check(number_from(0, 1e6))
      ->type_name("FACTOR")
      ->capture_default_str();
  add_off_switch(command, "--no-shadows", options.shadows,
                 "Leave the shadows of sun and lights out");
  command
      .add_option("--shadow-samples", options.shadow_samples,
                  "Shadow rays per pixel and light with soft edges")
      ->check(whole_number(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--ao", options.occlusion_samples, "Rays of ambient occlusion per pixel; 0: none")
      ->check(whole_number(0, 4096))
      ->type_name("N")
      ->capture_default_str();
  add_parsed_option(command, "--ao-distance", options.occlusion_distance, parse_positive, "LENGTH",
                    "How far occlusion reaches, in world units (default: 0.15 of the grid)");
  command
      .add_option("--ao-cone", options.occlusion_cone,
                  "End its rays at cells of this solid angle, such as 0.07; 0: never")
      ->check(number_from(0, 6))
      ->type_name("SR")
      ->capture_default_str();
}

void add_filter_options(CLI::App& command, std::optional<bool>& filter) {
  command.add_flag_callback(
      "--filter", [&filter] { filter = true; },
      "Smooth what voxels larger than pixels show (default: for an ESVO)");
  command
      .add_flag_callback(
          "--no-filter", [&filter] { filter = false; }, "Show every voxel as it is")
      ->excludes("--filter");
}

void add_quality_options(CLI::App& command, RenderOptions& options) {
  command.add_option("--spp,--samples", options.samples_per_pixel, "Samples per pixel")
      ->check(whole_number(1, 4096))
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--lod", options.lod_pixels,
                  "Stop at cells of this many pixels; 0: always at voxels")
      ->check(number_from(0, 1000))
      ->type_name("PIXELS")
      ->capture_default_str();
  add_off_switch(command, "--no-beams", options.beams,
                 "Cast every ray over its whole length: slower, the same picture");
  command
      .add_option("--exposure", options.exposure,
                  "Factor on the light before tone mapping (default: what suits the picture)")
      ->check(positive_number())
      ->type_name("FACTOR");
}

}  // namespace

void add_render_options(CLI::App& command, Session& session, RenderArguments& arguments) {
  command.add_option("file", session.subject, "The .vdag or .esvo file")
      ->type_name("FILE")
      ->required();
  command
      .add_option("-o,--output", arguments.output, "The picture: .png, or .exr for linear light")
      ->type_name("OUT")
      ->required();
  add_parsed_option(command, "--size", arguments.size, parse_image_size, "WxH",
                    "Pixels (default 1920x1080)");
  add_view_options(command, arguments.options.view);
  add_light_options(command, arguments.options);
  add_quality_options(command, arguments.options);
  add_filter_options(command, arguments.filter);
  command
      .add_option("--depth", arguments.depth, "Write the depth along the view: --pass depth=OUT")
      ->type_name("OUT");
  command.add_option("--normal", arguments.normal, "Write world space normals: --pass normal=OUT")
      ->type_name("OUT");
  add_list_option(command, "--pass", arguments.passes, parse_pass, "NAME=OUT",
                  "Also write picture, radiance, depth, normal, occlusion, shadow or steps as .exr "
                  "or .png; may be repeated");
  add_mesh_options(command, arguments.mesh);
  add_path_options(command, arguments.path);
  add_device_option(command, arguments.device);
  add_parsed_option(
      command, "--memory", arguments.stream_memory, parse_memory, "LIMIT",
      "Load only what is seen of an ESVO, into this much memory: 512M. The picture is "
      "there at once, coarse, and is written again as it becomes finer; the frames of --path are "
      "written once");
  add_threads_option(command, session);
  add_quiet_option(command, session);
}

void check_render_arguments(const RenderArguments& arguments, Session& session) {
  session.inputs = {arguments.mesh.file, arguments.path.file};
  check_mesh_options(arguments.mesh);
  if (arguments.stream_memory != 0 &&
      (!arguments.mesh.file.empty() || arguments.device.kind == DeviceChoice::Kind::kCuda))
    throw CLI::ValidationError("--memory", "not with --mesh or --device cuda");
  check_outputs(arguments, session);
  check_view(arguments.options.view);
  constexpr std::size_t kMostLights = RenderSetup::kMaxLights - 1;  // besides the sun
  if (arguments.options.lights.size() > kMostLights)
    throw CLI::ValidationError(
        "--light",
        fmt::format("there are {}, the most are {}", arguments.options.lights.size(), kMostLights));
}

std::vector<RenderPass> all_passes(const RenderArguments& arguments) {
  std::vector<RenderPass> passes = {{"picture", arguments.output}};
  if (!arguments.depth.empty()) passes.push_back({"depth", arguments.depth});
  if (!arguments.normal.empty()) passes.push_back({"normal", arguments.normal});
  passes.insert(passes.end(), arguments.passes.begin(), arguments.passes.end());
  return passes;
}

}  // namespace voxdag
