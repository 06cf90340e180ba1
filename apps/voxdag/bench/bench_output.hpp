#pragma once
/// The output files of `voxdag bench`.
#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/report/charts.hpp"
#include "cli/output_files.hpp"
#include "cli/session.hpp"

namespace voxdag {

struct BenchOutput {
  std::string json_file;  ///< Empty: none.
  std::array<std::string, 2> plot_files;

  std::vector<OutputFile> files() const;
  /// Throws UsageError if two files are the same, or one is an input.
  void check_distinct(const Session& session) const;
  /// Throws Error unless all files can be created and plots can be drawn. Call it before the work.
  void check_writable(const Progress& progress) const;
  /// Writes the files, and prints JSON or `text`. `charts` return the plots.
  void write(const nlohmann::ordered_json& json,
             const std::vector<std::function<Chart(const std::string& file)>>& charts,
             const std::string& text, Session& session) const;
};

}  // namespace voxdag
