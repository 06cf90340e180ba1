#include "bench/bench_output.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "voxdag/io/atomic_file.hpp"

namespace voxdag {

std::vector<OutputFile> BenchOutput::files() const {
  return {{"--output", json_file}, {"--plot", plot_files[0]}, {"--rays-plot", plot_files[1]}};
}

void BenchOutput::check_distinct(const Session& session) const {
  voxdag::check_distinct(files(), session);
}

void BenchOutput::check_writable(const Progress& progress) const {
  if (!json_file.empty()) voxdag::check_writable(json_file);
  bool has_plots = false;
  for (const std::string& file : plot_files) {
    if (file.empty()) continue;
    voxdag::check_writable(file);
    has_plots = true;
  }
  if (has_plots && !can_draw_charts(progress))
    throw Error(
        "matplotlib draws the plots, and it is not installed (apt install "
        "python3-matplotlib)");
}

void BenchOutput::write(const nlohmann::ordered_json& json,
                        const std::vector<std::function<Chart(const std::string&)>>& charts,
                        const std::string& text, Session& session) const {
  session.bar.clear();
  const std::string in_json = json_text(json);
  if (!json_file.empty()) write_whole_file(json_file, in_json);
  for (std::size_t i = 0; i < charts.size(); ++i)
    if (!plot_files[i].empty()) draw_charts({charts[i](plot_files[i])}, ".", session.progress);
  fmt::print("{}", session.json ? in_json : text);
}

}  // namespace voxdag
