#include "lab/commands/bench_output.hpp"

#include <fmt/core.h>

#include "lab/commands/report_program.hpp"
#include "lab/runs/scratch_folder.hpp"
#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag::lab {

std::vector<OutputFile> BenchOutput::files() const {
  return {{"--output", json_file}, {"--plot", plot_file}};
}

void BenchOutput::check_distinct(const Session& session) const {
  cli::check_distinct(files(), session);
}

void BenchOutput::check_writable(const Progress& progress) const {
  for (const std::string& file : {json_file, plot_file})
    if (!file.empty()) cli::check_writable(file);
  if (!plot_file.empty()) run_report({"show", "plots"}, progress);
}

void BenchOutput::write(const nlohmann::ordered_json& json, const std::string& text,
                        Session& session) const {
  session.bar.clear();
  const std::string in_json = json_text(json);
  if (!json_file.empty()) write_whole_file(json_file, in_json);
  fmt::print("{}", session.json ? in_json : text);
}

void BenchOutput::write_tables(const std::string& benchmark, const nlohmann::ordered_json& results,
                               const std::string& start, const std::string& end,
                               Session& session) const {
  std::string tables;
  if (!session.json || !plot_file.empty()) {
    const ScratchFolder scratch;
    const std::string file = scratch.path() / "results.json";
    write_whole_file(file, json_text(results));
    std::vector<std::string> arguments{"show", benchmark, file};
    if (!plot_file.empty()) arguments.push_back(plot_file);
    tables = run_report(arguments, session.progress);
  }
  write(results, start + tables + end, session);
}

void add_output_options(const Command& command, BenchOutput& output, const std::string& plot) {
  command.text("-o,--output", output.json_file, "FILE.json", "Also write the JSON to a file");
  command.text("--plot", output.plot_file, "FILE.svg", plot);
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
