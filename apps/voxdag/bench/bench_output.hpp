#pragma once
/// Where `voxdag bench` writes what it measured.
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace voxdag {

struct BenchOutput {
  std::string json_file;  ///< Or empty.
  std::array<std::string, 2> plot_files;

  /// Throws CLI::ValidationError where two files are the same.
  void check_distinct(const Session& session) const;
  /// Throws Error unless all files can be made: called before the work.
  void check_writable() const;
  /// Writes the files and prints JSON or `text`. `drawings` draw the plots that are wanted.
  void write(const nlohmann::ordered_json& json,
             const std::vector<std::function<std::string()>>& drawings, const std::string& text,
             Session& session) const;
};

}  // namespace voxdag
