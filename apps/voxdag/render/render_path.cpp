#include "render/render_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "cli/human.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "render/frame_names.hpp"
#include "render/frame_timings.hpp"
#include "render/path_file.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/render/camera_path.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The camera path of a file. What its first key leaves out, frame_scene finds.
CameraPath camera_path(const PathFile& path, const std::string& file, const VoxelSet& scene,
                       const Grid& grid, const RenderOptions& options) {
  std::vector<CameraKey> keys;
  try {
    for (const PathKey& key : path.keys) {
      CameraKey next;
      next.time = key.time;
      ViewRequest request{key.eye, key.target, key.up, key.fov_degrees};
      if (keys.empty()) {
        if ((key.up && options.view.up) || (key.fov_degrees && options.view.vertical_fov_degrees))
          throw Error(fmt::format("it has its own \"{0}\", which leaves --{0} without effect",
                                  key.up && options.view.up ? "up" : "fov"));
        if (!key.up) request.up = options.view.up;
        if (!key.fov_degrees) request.vertical_fov_degrees = options.view.vertical_fov_degrees;
      } else {
        const View& before = keys.back().view;
        if (!key.up) request.up = before.up;
        if (!key.fov_degrees) request.vertical_fov_degrees = before.vertical_fov_degrees;
      }
      next.view =
          frame_scene(scene, grid, static_cast<double>(options.width) / options.height, request);
      keys.push_back(next);
    }
    return CameraPath(std::move(keys));
  } catch (const Error& error) {
    if (!error.place().empty()) throw error.in_file(file);
    throw Error(file, fmt::format("key {}", keys.size()), error.reason());
  }
}

void set_view(RenderOptions& options, const View& view) {
  options.view = {view.eye, view.target, view.up, view.vertical_fov_degrees};
}

/// What would expose each frame well, made smooth, so that the eye seems to adapt: from small
/// pictures, in the mean over a second or so around each frame.
std::vector<float> exposures(const CameraPath& path, const std::vector<double>& times,
                             RenderOptions options, const FrameMaker& maker, Session& session) {
  constexpr double kSpread = 0.5;  // standard deviation, seconds
  if (options.exposure > 0) return std::vector<float>(times.size(), options.exposure);
  options.width = 64;
  options.height = 36;
  options.samples_per_pixel = 1;
  options.shadow_samples = std::min(options.shadow_samples, 4);
  options.occlusion_samples = std::min(options.occlusion_samples, 8);
  std::vector<double> logs;
  for (const double time : times) {
    set_view(options, path.at(time));
    logs.push_back(std::log(static_cast<double>(maker.render(options, nullptr).exposure)));
    session.progress.throw_if_cancelled();
    session.progress.report("exposure",
                            static_cast<double>(logs.size()) / static_cast<double>(times.size()),
                            logs.size());
  }
  std::vector<float> smooth;
  for (const double time : times) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double d = (times[i] - time) / kSpread;
      const double w = std::exp(-0.5 * d * d);
      sum += w * logs[i];
      weight += w;
    }
    smooth.push_back(static_cast<float>(std::exp(sum / weight)));
  }
  return smooth;
}

/// Throws Error where two files of the film would have the same name: of f%d.png and f1%d.png
/// that is frame 11 of the one and frame 1 of the other. Or where one is read.
void check_frame_names(const std::vector<RenderPass>& passes, int frames,
                       const std::string& timings, const Session& session) {
  std::unordered_set<std::string> names;
  const auto add = [&](const std::string& path) {
    if (!names.insert(place_of(path).string()).second)
      throw Error(path, "", "two files of the film have this name");
    for (const std::string& input : session.inputs)
      if (are_same_file(path, input)) throw Error(path, "", "is read, and a file of the film");
    if (are_same_file(path, session.subject)) throw Error(path, "", "is the scene of the film");
  };
  if (!timings.empty()) {
    add(timings);
    add(timings_plot(timings));
  }
  for (const RenderPass& pass : passes)
    for (int frame = 0; frame < frames; ++frame) add(frame_name(pass.path, frame));
}

}  // namespace

std::string timings_plot(const std::string& csv) {
  return std::filesystem::path(csv).replace_extension(".svg").string();
}

void add_path_options(CLI::App& command, PathArguments& arguments) {
  CLI::Option* const path =
      command
          .add_option(
              "--path", arguments.file,
              "Make a film: camera keys as JSON (see `voxdag scene NAME --path`); the names of "
              "the files then hold a number, such as frame_%04d.png")
          ->excludes("--eye")
          ->excludes("--target")
          ->type_name("KEYS.json");
  add_parsed_option(command, "--fps", arguments.fps, parse_positive, "N",
                    "Frames of the film for each second (default 30)")
      ->needs(path);
  command
      .add_option("--timings", arguments.timings,
                  "Write what each frame took, and a plot beside it as .svg")
      ->needs(path)
      ->type_name("OUT.csv");
}

void check_frame_pattern(const OutputFile& output, const PathArguments& arguments) {
  const auto refuse = [&](const std::string& reason) {
    throw CLI::ValidationError(output.option, fmt::format("\"{}\" {}", output.path, reason));
  };
  const std::string fault = frame_pattern_fault(output.path);
  if (!arguments.file.empty() && !fault.empty()) refuse(fault);
  if (arguments.file.empty() && fault.empty())
    refuse("has a place for a frame's number, which needs --path");
}

void render_path(const VoxelSet& scene, const Grid& grid, const RenderOptions& given,
                 const PathArguments& arguments, const FrameMaker& maker, Session& session) {
  constexpr double kMostFrames = 1e6;
  const PathFile file = read_path_file(arguments.file);
  RenderOptions options = given;
  const bool has_up = options.view.up || (!file.keys.empty() && file.keys.front().up);
  if (!has_up && maker.find_up && !file.keys.empty())
    options.view.up = up_across(maker.find_up(), file.keys.front().target - file.keys.front().eye);
  const CameraPath path = camera_path(file, arguments.file, scene, grid, options);
  const double count = std::floor((path.end() - path.start()) * arguments.fps + 1e-6) + 1;
  if (!(count <= kMostFrames)) throw Error(arguments.file, "", "a million frames are too many");
  check_frame_names(maker.passes, static_cast<int>(count), arguments.timings, session);
  for (const std::string& out : {arguments.timings, timings_plot(arguments.timings)})
    if (!arguments.timings.empty()) check_writable(out);
  if (!options.sun) options.sun = file.sun;
  if (!options.sun) {
    RenderOptions first = options;
    set_view(first, path.at(path.start()));
    options.sun = static_cast<Vec3d>(RenderPlan(scene, grid, first).setup().sky.sun);
  }

  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i)
    times.push_back(path.start() + i / arguments.fps);
  const auto start = Clock::now();
  const std::vector<float> exposure = exposures(path, times, options, maker, session);
  std::vector<FrameTiming> timings;
  for (std::size_t i = 0; i < times.size(); ++i) {
    FrameTiming timing;
    timing.frame = static_cast<int>(i);
    timing.time = times[i];
    set_view(options, path.at(times[i]));
    options.exposure = exposure[i];
    auto stage = Clock::now();
    const RenderedImage image = maker.render(options, nullptr);
    session.progress.throw_if_cancelled();
    timing.render_ms = milliseconds_since(stage);
    timing.rays = image.rays;
    stage = Clock::now();
    for (const RenderPass& pass : maker.passes)
      write_pass({pass.name, frame_name(pass.path, timing.frame)}, image);
    timing.write_ms = milliseconds_since(stage);
    timings.push_back(timing);
    session.progress.report("frames", static_cast<double>(i + 1) / count, i + 1);
  }
  if (!arguments.timings.empty()) {
    write_whole_file(arguments.timings, timings_csv(timings));
    write_whole_file(timings_plot(arguments.timings), timings_svg(timings));
  }
  session.bar.clear();
  if (session.quiet) return;
  std::uint64_t rays = 0;
  double render_ms = 0;
  for (const FrameTiming& timing : timings) {
    rays += timing.rays;
    render_ms += timing.render_ms;
  }
  fmt::print("{} frames of {} x {} pixels in {}, {:.1f} ms each, {} rays/s\n", timings.size(),
             options.width, options.height, human_seconds(milliseconds_since(start) / 1000),
             render_ms / count, human_count(static_cast<double>(rays) / render_ms * 1000));
}

}  // namespace voxdag
