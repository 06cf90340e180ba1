#pragma once
/// The output files of `voxdag bench`.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/output_files.hpp"
#include "cli/session.hpp"
#include "lab/runs/machine.hpp"

namespace voxdag::lab {
using namespace cli;

struct BenchOutput {
  std::string json_file, plot_file;  ///< Empty: none.

  std::vector<OutputFile> files() const;
  /// Throws UsageError if two files are the same, or one is an input.
  void check_distinct(const Session& session) const;
  /// Throws Error unless all files can be created and plots can be drawn. Call it before the work.
  void check_writable(const Progress& progress) const;
  /// Writes the files, and prints the JSON or `text`.
  void write(const nlohmann::ordered_json& json, const std::string& text, Session& session) const;
  /// Writes the files, and prints the JSON or `start`, the tables of `results` and `end`. The
  /// program in lab/report prints the tables and draws the plot of `benchmark` from the JSON.
  void write_tables(const std::string& benchmark, const nlohmann::ordered_json& results,
                    const std::string& start, const std::string& end, Session& session) const;
};

/// Adds --output and --plot, whose help is `plot`.
void add_output_options(const Command& command, BenchOutput& output, const std::string& plot);

/// Adds --threads, --quiet and --json.
void add_run_options(const Command& command, Session& session);

/// Returns the line above a table: the processor, its cores and the load before the benchmark.
std::string machine_text(const nlohmann::ordered_json& machine);

/// Checks the outputs, measures, and writes the results of `benchmark`, which it returns. measure()
/// returns them; json(results, machine) describes them.
template <class Measure, class Json>
auto measure_and_write(const std::string& benchmark, const BenchOutput& output, Session& session,
                       const Measure& measure, const Json& json) {
  output.check_writable(session.progress);
  const nlohmann::ordered_json machine = machine_json();
  auto results = measure();
  output.write_tables(benchmark, json(results, machine), machine_text(machine), "", session);
  return results;
}

/// Sorts values and removes repeated ones.
template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace voxdag::lab
