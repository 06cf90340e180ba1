#include "render/render_film.hpp"

#include <fmt/core.h>

#include <numeric>
#include <optional>
#include <unordered_set>

#include "cli/job.hpp"
#include "cli/output_files.hpp"
#include "cli/stopwatch.hpp"
#include "render/film_file.hpp"
#include "voxdag/cluster/rank_queue.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/render/film/frame_names.hpp"
#include "voxdag/render/film/path_file.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag::cli {
namespace {

constexpr int kFrameCounter = 0;

/// Throws Error if the path and an option of the command line both set a value.
void check_own_view(const PathFile& path, const ViewRequest& asked) {
  if (path.keys.empty()) return;
  const PathKey& first = path.keys.front();
  const auto refuse = [&](const char* name) {
    throw Error(path.name, "key 0", fmt::format("has \"{0}\", so --{0} has no effect", name));
  };
  if (first.up && asked.up) refuse("up");
  if (first.fov_degrees && asked.vertical_fov_degrees) refuse("fov");
}

/// Throws Error if two files of the film have the same name (such as frame 11 of f%d.png and frame
/// 1 of f1%d.png), or if a file is also an input.
void check_file_names(const RenderArguments& arguments, const std::vector<PicturePass>& passes,
                      std::size_t frames, const Session& session) {
  std::unordered_set<std::string> names;
  const auto add = [&](const std::string& path) {
    if (!names.insert(canonical_output(path).string()).second)
      throw Error(path, "", "two files of the film have this name");
    for (const std::string& input : session.inputs)
      if (are_same_file(path, input))
        throw Error(path, "", "is both an input and an output of the film");
    if (are_same_file(path, session.subject))
      throw Error(path, "", "is both the scene and an output of the film");
  };
  if (!arguments.path.timings.empty()) add(arguments.path.timings);
  for (const PicturePass& pass : passes)
    for (std::size_t frame = 0; frame < frames; ++frame)
      add(frame_name(pass.path, static_cast<int>(frame)));
}

CameraPath read_camera_path(const PathFile& file, const FilmScene& scene,
                            const RenderOptions& options) {
  ViewRequest first = options.view;
  check_own_view(file, first);
  const bool has_up = first.up || (!file.keys.empty() && file.keys.front().up);
  if (!has_up && !first.scene_up && scene.find_up && !file.keys.empty())
    first.up = up_across(scene.find_up(), file.keys.front().target - file.keys.front().eye);
  return make_camera_path(file, scene.voxels, scene.grid,
                          static_cast<double>(options.width) / options.height, first);
}

/// Returns the direction towards the sun in the first frame.
Vec3d sun_of_first_frame(const Film& film, const FilmScene& scene) {
  RenderOptions options = film.options;
  options.view = as_request(film.path.at(film.path.start()), options.view);
  return static_cast<Vec3d>(RenderPlan(scene.voxels, scene.grid, options).setup().sky.sun);
}

void print_summary(const Film& film, const std::vector<FrameTiming>& timings, double seconds,
                   int ranks) {
  std::uint64_t rays = 0;
  double render_ms = 0;
  for (const FrameTiming& timing : timings) {
    rays += timing.rays;
    render_ms += timing.render_ms;
  }
  fmt::print("{} frames of {} x {} pixels in {}, {:.1f} ms each, {} rays/s{}\n", timings.size(),
             film.options.width, film.options.height, human_seconds(seconds),
             render_ms / static_cast<double>(timings.size()),
             human_count(static_cast<double>(rays) / render_ms * 1000),
             ranks == 1 ? "" : fmt::format(" in each of {} processes", ranks));
}

}  // namespace

void render_film(const RenderArguments& arguments, const FilmScene& scene,
                 const RenderOptions& options, Session& session) {
  const std::string& csv = arguments.path.timings;
  const PathFile file = read_path_file(arguments.path.file);
  Film film{read_camera_path(file, scene, options), arguments.path.frames_per_second, options,
            all_passes(arguments)};
  Job& job = *session.job;
  std::optional<FilmFile> film_file;
  if (is_film_path(arguments.output)) {
    if (job.count() > 1)
      throw Error(arguments.output, "",
                  "one process makes a film: let several write frames (-o frame_%04d.png)");
    if (options.background == Background::kTransparent)
      throw Error(arguments.output, "", "a film has no alpha: choose another --background");
    film_file.emplace(arguments.output, film.frames_per_second);
    film.passes[0].path = film_file->frames();
  }
  std::size_t frames = 0;
  try {
    frames = frame_times(film.path, film.frames_per_second).size();
  } catch (const Error& error) {
    throw Error(file.name, "", error.reason());
  }
  if (job.is_first()) {
    // No other rank begins a frame before this one does.
    check_file_names(arguments, film.passes, frames, session);
    if (!csv.empty()) check_writable(csv);
  }
  if (!film.options.sun) film.options.sun = file.sun;
  if (!film.options.sun) film.options.sun = sun_of_first_frame(film, scene);

  if (job.is_first())
    announce_cost(fmt::format("the film of {} frames", with_commas(frames)),
                  estimate_seconds(film, scene.render) / job.count(), session);
  const Stopwatch watch;
  RankQueue queue(job.ranks(), kFrameCounter);
  const std::vector<FrameTiming> timings =
      render_film(film, scene.render, queue, &session.progress);
  if (!job.is_first()) return;
  if (!csv.empty()) write_whole_file(csv, timings_csv(timings));
  if (film_file) film_file->encode(session.progress);
  session.bar.clear();
  if (!session.quiet) print_summary(film, timings, watch.since_start(), job.count());
}

}  // namespace voxdag::cli
