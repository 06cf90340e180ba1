#include "lab/commands/bench_output.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag::lab {

std::vector<OutputFile> BenchOutput::files() const {
  return {{"--output", json_file}, {"--plot", plot_files[0]}, {"--rays-plot", plot_files[1]}};
}

void BenchOutput::check_distinct(const Session& session) const {
  cli::check_distinct(files(), session);
}

void BenchOutput::check_writable(const Progress& progress) const {
  if (!json_file.empty()) cli::check_writable(json_file);
  bool has_plots = false;
  for (const std::string& file : plot_files) {
    if (file.empty()) continue;
    cli::check_writable(file);
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

void add_output_options(const Command& command, BenchOutput& output, const std::string& plot) {
  command.text("-o,--output", output.json_file, "FILE.json", "Also write the JSON to a file");
  command.text("--plot", output.plot_files[0], "FILE.svg", plot);
}

void add_run_options(const Command& command, Session& session) {
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
}

std::string machine_text(const nlohmann::ordered_json& machine) {
  return fmt::format("{} ({} cores), load average {:.2f} before\n\n",
                     machine.at("processor").get<std::string>(), machine.at("cores").get<int>(),
                     machine.at("load_average").get<double>());
}

}  // namespace voxdag::lab
