#pragma once
/// The output files of `voxdag bench`.
#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/output_files.hpp"
#include "cli/session.hpp"

namespace voxdag {

struct BenchOutput {
  std::string json_file;  ///< Empty: none.
  std::array<std::string, 2> plot_files;

  std::vector<OutputFile> files() const;
  /// Throws UsageError if two files are the same, or one is an input.
  void check_distinct(const Session& session) const;
  /// Throws Error unless all files can be created. Call it before the work.
  void check_writable() const;
  /// Writes the files, and prints JSON or `text`. `drawings` return the plots.
  void write(const nlohmann::ordered_json& json,
             const std::vector<std::function<std::string()>>& drawings, const std::string& text,
             Session& session) const;
};

}  // namespace voxdag
