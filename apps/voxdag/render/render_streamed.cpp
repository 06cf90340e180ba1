#include "render/render_streamed.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>

#include "cli/job.hpp"
#include "cli/output_files.hpp"
#include "cli/stopwatch.hpp"
#include "render/picture_summary.hpp"
#include "render/render_film.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/cpu/stream/paged_cells.hpp"
#include "voxdag/cpu/stream/stream_blocks.hpp"
#include "voxdag/cuda/device_stream.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/render/coarse_cells.hpp"

namespace voxdag::cli {
namespace {

/// The blocks of the file, on the chosen device.
struct Streamed {
  Streamed(const std::filesystem::path& path, std::uint64_t memory, const DeviceChoice& choice)
      : blocks(path, memory) {
    if (choice.kind == DeviceChoice::Kind::kCpu) return;
    try {
      on_device.emplace(choose_cuda_device(choice.index), blocks);
    } catch (const Error& error) {
      if (choice.kind == DeviceChoice::Kind::kCuda) throw Error("--device cuda", "", error.what());
    }
  }

  RenderedImage render(const RenderOptions& options,
                       const std::function<void(const RenderedImage&)>& on_pass, Work work) {
    const Grid& grid = blocks.stream().grid();
    if (on_device) return voxdag::render_streamed(*on_device, grid, options, on_pass, work);
    return voxdag::render_streamed(blocks, grid, options, on_pass, work);
  }

  StreamBlocks blocks;
  std::optional<DeviceStream> on_device;
};

/// Returns the options of a streamed picture.
RenderOptions streamed_options(const RenderArguments& arguments, const StreamBlocks& blocks) {
  RenderOptions options = picture_options(arguments, true);
  show_as(blocks.stream().metadata().presentation, options.view);
  return options;
}

/// Renders a film. Blocks that a frame has loaded stay loaded for the next frame.
void render_streamed_film(const RenderArguments& arguments, Streamed& streamed, Session& session) {
  StreamBlocks& blocks = streamed.blocks;
  const Grid& grid = blocks.stream().grid();
  // A frame may take long: it reports its own progress and can be cancelled.
  const auto render = [&](const RenderOptions& options, Work) {
    return streamed.render(options, {}, &session.progress);
  };
  const auto find_up = [&] { return guess_up(CoarseCells::of(PagedCells(blocks), kUpLevel)); };
  render_film(arguments, {blocks.view(), grid, render, find_up},
              streamed_options(arguments, blocks), session);
}

/// Renders a picture. Writes the outputs after each pass; each pass is finer than the one before.
void render_streamed_picture(const RenderArguments& arguments, Streamed& streamed,
                             Session& session) {
  const auto write = [&](const RenderedImage& image) {
    for (const PicturePass& pass : all_passes(arguments)) write_pass(*pass.kind, pass.path, image);
  };
  Stopwatch watch;
  double first_seconds = 0;
  const auto on_pass = [&](const RenderedImage& image) {
    if (!is_standard_output(arguments.output)) write(image);
    if (first_seconds == 0) first_seconds = watch.since_start();
  };
  const RenderOptions options = streamed_options(arguments, streamed.blocks);
  const RenderedImage image = streamed.render(options, on_pass, &session.progress);
  const double seconds = watch.since_start();
  write(image);
  session.bar.clear();
  if (session.quiet) return;
  print_picture_summary(
      arguments.output, image, seconds, device_name(streamed.on_device),
      is_up_guessed(options.view, streamed.blocks.stream().metadata().presentation));
  fmt::print("  first picture after {}\n",
             human_seconds(first_seconds > 0 ? first_seconds : seconds));
}

}  // namespace

void render_streamed(const RenderArguments& arguments, Session& session) {
  Streamed streamed(session.subject, arguments.stream_memory, arguments.device);
  if (arguments.path.file.empty())
    render_streamed_picture(arguments, streamed, session);
  else
    render_streamed_film(arguments, streamed, session);
  if (session.quiet) return;
  const StreamBlocks& blocks = streamed.blocks;
  const EsvoStreamCounts& counts = blocks.stream().counts();
  std::uint64_t all = 0;
  for (const EsvoBlockEntry& entry : blocks.stream().directory()) all += entry.slots * 8ull;
  if (session.job && session.job->count() > 1) fmt::print("  in process 0:\n");
  fmt::print("  {} of {} blocks used, {} of {} in memory at the end\n",
             with_commas(counts.blocks_used), with_commas(blocks.stream().directory().size()),
             human_bytes(counts.bytes_loaded), human_bytes(all));
  fmt::print("  {} read, {} blocks more than once\n", human_bytes(counts.bytes_read),
             with_commas(counts.blocks_read - counts.blocks_used));
}

}  // namespace voxdag::cli
