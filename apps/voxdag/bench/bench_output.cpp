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

void BenchOutput::check_writable() const {
  if (!json_file.empty()) voxdag::check_writable(json_file);
  for (const std::string& file : plot_files)
    if (!file.empty()) voxdag::check_writable(file);
}

void BenchOutput::write(const nlohmann::ordered_json& json,
                        const std::vector<std::function<std::string()>>& drawings,
                        const std::string& text, Session& session) const {
  session.bar.clear();
  const std::string in_json = json_text(json);
  if (!json_file.empty()) write_whole_file(json_file, in_json);
  for (std::size_t i = 0; i < drawings.size(); ++i)
    if (!plot_files[i].empty()) write_whole_file(plot_files[i], drawings[i]());
  fmt::print("{}", session.json ? in_json : text);
}

}  // namespace voxdag
