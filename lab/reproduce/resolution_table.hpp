#pragma once
/// A table of the report with a column for each resolution.
#include <string>
#include <utility>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {

class ResolutionTable {
 public:
  ResolutionTable(std::string caption, std::vector<int> levels) : levels_(std::move(levels)) {
    table_.caption = std::move(caption);
    table_.header = {"scene", ""};
    table_.text_columns = 2;
    for (const int level : levels_) table_.header.push_back(short_resolution(level));
  }

  /// Adds a row with a cell for each resolution: text(levels).
  template <class Text>
  void add(const std::string& scene, const std::string& what, const Text& text) {
    std::vector<std::string> row{scene == last_scene_ ? "" : scene, what};
    last_scene_ = scene;
    for (const int level : levels_) row.push_back(text(level));
    table_.rows.push_back(std::move(row));
  }

  Table take() { return std::move(table_); }

 private:
  std::vector<int> levels_;
  std::string last_scene_;
  Table table_;
};

}  // namespace voxdag::lab
