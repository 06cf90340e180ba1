#include "render/render_streamed.hpp"

#include <fmt/format.h>

#include "cli/device.hpp"
#include "cli/human.hpp"
#include "cli/process_usage.hpp"
#include "render/render_summary.hpp"
#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/stream/paged_cells.hpp"
#include "voxdag/stream/stream_blocks.hpp"

namespace voxdag {
namespace {

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
  print_summary(arguments.output, image, seconds, device_name(std::nullopt));
  fmt::print("  first picture after {}\n",
             human_seconds(first_seconds > 0 ? first_seconds : seconds));
}

}  // namespace

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

}  // namespace voxdag
