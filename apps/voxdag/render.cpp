/// `voxdag render`: a picture of a .vdag or .esvo file.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>

#include "commands.hpp"
#include "device.hpp"
#include "frame_names.hpp"
#include "human.hpp"
#include "number_check.hpp"
#include "parse.hpp"
#include "process_usage.hpp"
#include "render_light.hpp"
#include "render_mesh.hpp"
#include "render_passes.hpp"
#include "render_path.hpp"
#include "scene_file.hpp"
#include "voxdag/cpu/paged_cells.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/stream/stream_blocks.hpp"

namespace voxdag {
namespace {

struct RenderArguments {
  std::string output, depth, normal;
  std::vector<RenderPass> passes;
  ImageSize size{1920, 1080};
  RenderOptions options;
  std::optional<bool> filter;  ///< Without: for ESVOs.
  MeshArguments mesh;
  PathArguments path;
  DeviceChoice device;
  std::uint64_t stream_memory = 0;  ///< Of an ESVO's blocks, bytes; 0: all are loaded.
};

/// Every picture to write.
std::vector<RenderPass> all_passes(const RenderArguments& arguments) {
  std::vector<RenderPass> passes = {{"picture", arguments.output}};
  if (!arguments.depth.empty()) passes.push_back({"depth", arguments.depth});
  if (!arguments.normal.empty()) passes.push_back({"normal", arguments.normal});
  passes.insert(passes.end(), arguments.passes.begin(), arguments.passes.end());
  return passes;
}

/// Throws CLI::ValidationError for names of outputs that are wrong, alone or together.
void check_outputs(const RenderArguments& arguments) {
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
  check_distinct(outputs);
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

void print_summary(const RenderArguments& arguments, const RenderedImage& image, double seconds,
                   const std::string& device) {
  fmt::print("{}: {} x {} pixels in {}, {} rays/s on {}\n", arguments.output, image.width,
             image.height, human_seconds(seconds),
             human_count(static_cast<double>(image.rays) / seconds), device);
  const View& view = image.view;
  // The shortest numbers that read back as the same: the options make the same picture.
  fmt::print("  --eye {},{},{} --target {},{},{} --up {},{},{} --fov {} --exposure {}\n",
             view.eye.x, view.eye.y, view.eye.z, view.target.x, view.target.y, view.target.z,
             view.up.x, view.up.y, view.up.z, view.vertical_fov_degrees, image.exposure);
  if (image.steps.empty()) return;
  const double sum = std::accumulate(image.steps.begin(), image.steps.end(), 0.0);
  fmt::print("  steps per primary ray: {:.1f} on average, {:.0f} at most\n",
             sum / static_cast<double>(image.steps.size()),
             static_cast<double>(*std::max_element(image.steps.begin(), image.steps.end())));
}

/// A film of an ESVO: what a frame has loaded is there for the next one.
void render_streamed_path(const RenderArguments& arguments, const std::vector<RenderPass>& passes,
                          StreamBlocks& blocks, Session& session) {
  const Grid& grid = blocks.stream().grid();
  // A frame may take long, so that each tells how far it is and can be cancelled.
  const auto render_frame = [&](const RenderOptions& options, Progress*) {
    return render_streamed(blocks, grid, options, {}, &session.progress);
  };
  const auto find_up = [&] { return guess_up(CoarseCells::of(PagedCells(blocks), kUpLevel)); };
  render_path(blocks.view(), grid, arguments.options, arguments.path,
              {render_frame, passes, find_up}, session);
}

/// A picture of an ESVO. The outputs are there from the first pass on and become finer.
void render_streamed_picture(const RenderArguments& arguments,
                             const std::vector<RenderPass>& passes, StreamBlocks& blocks,
                             Session& session) {
  const auto write = [&](const RenderedImage& image) {
    for (const RenderPass& pass : passes) write_pass(pass, image);
  };
  Stopwatch watch;
  double first_seconds = 0;
  const auto on_pass = [&](const RenderedImage& image) {
    write(image);
    if (first_seconds == 0) first_seconds = watch.since_start();
  };
  const RenderedImage image = render_streamed(blocks, blocks.stream().grid(), arguments.options,
                                              on_pass, &session.progress);
  const double seconds = watch.since_start();
  write(image);
  session.bar.clear();
  if (session.quiet) return;
  print_summary(arguments, image, seconds, device_name(std::nullopt));
  fmt::print("  first picture after {}\n",
             human_seconds(first_seconds > 0 ? first_seconds : seconds));
}

/// `--memory`: an ESVO's blocks are loaded while pictures of it are made.
void render_streamed(const RenderArguments& arguments, const std::vector<RenderPass>& passes,
                     Session& session) {
  StreamBlocks blocks(session.subject, arguments.stream_memory);
  if (arguments.path.file.empty())
    render_streamed_picture(arguments, passes, blocks, session);
  else
    render_streamed_path(arguments, passes, blocks, session);
  if (session.quiet) return;
  const EsvoStreamCounts& counts = blocks.stream().counts();
  std::uint64_t all = 0;
  for (const EsvoBlockEntry& entry : blocks.stream().directory()) all += entry.slots * 8ull;
  fmt::print("  {} of {} blocks used, {} of {} in memory at the end\n",
             with_commas(counts.blocks_used), with_commas(blocks.stream().directory().size()),
             human_bytes(counts.bytes_loaded), human_bytes(all));
  fmt::print("  {} read, {} blocks a second time or more\n", human_bytes(counts.bytes_read),
             with_commas(counts.blocks_read - counts.blocks_used));
}

void render(RenderArguments& arguments, Session& session) {
  const std::vector<RenderPass> passes = all_passes(arguments);
  for (const RenderPass& pass : passes) {
    check_writable(frame_name(pass.path, 0));
    if (pass.name == "steps") arguments.options.with_steps = true;
  }
  if (arguments.stream_memory != 0) {
    if (!is_esvo_file(session.subject))
      throw Error(session.subject, "", "--memory is for an ESVO, and this is a DAG");
    arguments.options.width = arguments.size.width;
    arguments.options.height = arguments.size.height;
    arguments.options.filter = arguments.filter.value_or(true);
    return render_streamed(arguments, passes, session);
  }
  const SceneFile file(session.subject);
  const VoxelScene scene = file.scene();
  arguments.options.width = arguments.size.width;
  arguments.options.height = arguments.size.height;
  arguments.options.filter = arguments.filter.value_or(scene.esvo() != nullptr);
  const std::optional<DeviceScene> device_dag = load_on_device(arguments.device, scene);
  std::optional<CpuScene> cpu_scene;
  if (!device_dag) cpu_scene.emplace(scene);
  const std::unique_ptr<ViewSource> source =
      open_view_source(arguments.mesh, arguments.options.albedo, scene, file.grid(), session);
  const auto render_frame = [&](const RenderOptions& options, Progress* progress) {
    if (device_dag) return render_image(*device_dag, file.grid(), options, progress, source.get());
    return render_image(*cpu_scene, file.grid(), options, progress, source.get());
  };
  if (!arguments.path.file.empty())
    return render_path(scene, file.grid(), arguments.options, arguments.path,
                       {render_frame, passes, {}}, session);
  const auto start = std::chrono::steady_clock::now();
  const RenderedImage image = render_frame(arguments.options, &session.progress);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const RenderPass& pass : passes) write_pass(pass, image);
  session.bar.clear();
  if (!session.quiet) print_summary(arguments, image, seconds, device_name(device_dag));
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

void add_render_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<RenderArguments>();
  RenderOptions& options = arguments->options;
  CLI::App& command =
      add_command(app, "render", "Make a picture: sun, sky, shadows and ambient occlusion",
                  "voxdag render scene.vdag -o scene.png --size 1920x1080");
  command.add_option("file", session.subject, "The .vdag or .esvo file")
      ->type_name("FILE")
      ->required();
  command
      .add_option("-o,--output", arguments->output, "The picture: .png, or .exr for linear light")
      ->type_name("OUT")
      ->required();
  add_parsed_option(command, "--size", arguments->size, parse_image_size, "WxH",
                    "Pixels (default 1920x1080)");
  add_view_options(command, options.view);
  add_light_options(command, options);
  add_quality_options(command, options);
  add_filter_options(command, arguments->filter);
  command
      .add_option("--depth", arguments->depth, "Write the depth along the view: --pass depth=OUT")
      ->type_name("OUT");
  command.add_option("--normal", arguments->normal, "Write world space normals: --pass normal=OUT")
      ->type_name("OUT");
  add_list_option(command, "--pass", arguments->passes, parse_pass, "NAME=OUT",
                  "Also write picture, radiance, depth, normal, occlusion, shadow or steps as .exr "
                  "or .png; may be repeated");
  add_mesh_options(command, arguments->mesh);
  add_path_options(command, arguments->path);
  add_device_option(command, arguments->device);
  add_parsed_option(
      command, "--memory", arguments->stream_memory, parse_memory, "LIMIT",
      "Load only what is seen of an ESVO, into this much memory: 512M. The picture is "
      "there at once, coarse, and is written again as it becomes finer; the frames of --path are "
      "written once");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.callback([arguments, &session] {
    check_mesh_options(arguments->mesh);
    if (arguments->stream_memory != 0 &&
        (!arguments->mesh.file.empty() || arguments->device.kind == DeviceChoice::Kind::kCuda))
      throw CLI::ValidationError("--memory", "not with --mesh or --device cuda");
    check_outputs(*arguments);
    check_view(arguments->options.view);
    constexpr std::size_t kMostLights = RenderSetup::kMaxLights - 1;  // besides the sun
    if (arguments->options.lights.size() > kMostLights)
      throw CLI::ValidationError(
          "--light", fmt::format("there are {}, the most are {}", arguments->options.lights.size(),
                                 kMostLights));
    session.work = [arguments, &session] { render(*arguments, session); };
  });
}

}  // namespace voxdag
