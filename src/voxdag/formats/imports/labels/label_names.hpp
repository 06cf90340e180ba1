#pragma once
/// The names of labels.
#include <map>
#include <string>
#include <unordered_set>
#include <vector>

#include "voxdag/formats/imports/import_voxels.hpp"

namespace voxdag {

/// Returns a name for each label: that of `known`, or its number. Where several have one name,
/// their numbers follow it: "tree 7".
std::vector<std::string> names_of_labels(const std::vector<Label>& labels,
                                         const std::map<Label, std::string>& known);

/// Decides by ImportOptions::labels which labels are read.
class LabelFilter {
 public:
  /// Throws Error, without a file, for a name that is none of the source and no number.
  LabelFilter(const VoxelSource& source, const ImportOptions& options);

  bool keeps(Label label) const { return is_for_all_ || labels_.contains(label) != drops_; }

 private:
  bool is_for_all_, drops_;
  std::unordered_set<Label> labels_;
};

}  // namespace voxdag
