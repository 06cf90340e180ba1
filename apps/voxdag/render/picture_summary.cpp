#include "render/picture_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cli/output_files.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {

void print_picture_summary(const std::string& file, const RenderedImage& image, double seconds,
                           const std::string& device, bool is_up_guessed) {
  fmt::print("{}: {} x {} pixels in {}, {} rays/s on {}\n", with_output_name(file), image.width,
             image.height, human_seconds(seconds),
             human_count(static_cast<double>(image.rays) / seconds), device);
  const View& view = image.view;
  if (is_up_guessed) fmt::print("  up is guessed from the shape of the scene; --up sets it\n");
  // {} prints the shortest number that parses to the same value, so the options reproduce the
  // picture.
  fmt::print("  --eye {},{},{} --target {},{},{} --up {},{},{} --fov {} --exposure {}\n",
             view.eye.x, view.eye.y, view.eye.z, view.target.x, view.target.y, view.target.z,
             view.up.x, view.up.y, view.up.z, view.vertical_fov_degrees, image.exposure);
  if (image.steps.empty()) return;
  const double sum = std::accumulate(image.steps.begin(), image.steps.end(), 0.0);
  fmt::print("  steps per primary ray: {:.1f} on average, {:.0f} at most\n",
             sum / static_cast<double>(image.steps.size()),
             static_cast<double>(*std::max_element(image.steps.begin(), image.steps.end())));
}

}  // namespace voxdag::cli
