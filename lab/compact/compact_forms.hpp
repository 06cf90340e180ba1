#pragma once
/// The forms that `voxdag bench compact` compares.
#include <span>

#include "lab/runs/size_in_parts.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag::lab {

struct CompactForm {
  const char* key;    ///< In JSON and on the command line: "ssvdag".
  const char* title;  ///< In tables and plots: "SSVDAG".
  /// Encodes the DAG and returns its size. Throws Error and Cancelled.
  SizeInParts (*measure)(const SvdagView& dag, Progress& progress);
  bool is_random_access = true;  ///< Whether rays can walk it. Plots show only such forms.
};

/// Returns all forms, in the order of tables. A new form needs its line in this list only.
std::span<const CompactForm> compact_forms();

/// The form of files and rays. Sizes of other forms are given as parts of it.
inline constexpr const char* kReferenceForm = "svdag";

}  // namespace voxdag::lab
