#pragma once
/// Which words and leaf blocks of a DAG that is being edited were written, for copies elsewhere.
#include <cstdint>
#include <vector>

namespace voxdag {

/// A run of words or of leaf blocks.
struct EditRun {
  std::uint64_t first = 0, count = 0;
};

/// Extends the last run if it ends where the new one begins, else appends the new one.
inline void note_run(std::vector<EditRun>& runs, std::uint64_t first, std::uint64_t count) {
  if (!runs.empty() && runs.back().first + runs.back().count == first)
    runs.back().count += count;
  else
    runs.push_back({first, count});
}

/// The runs that were written, in the order of writing. A run may lie in an earlier one.
struct EditChanges {
  std::vector<EditRun> words, blocks;
};

}  // namespace voxdag
