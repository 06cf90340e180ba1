#pragma once
/// The log of a job: a line of JSON for each part that a rank has built.
#include <chrono>
#include <cstdint>
#include <fstream>

#include "voxdag/cluster/work_folder.hpp"

namespace voxdag {

/// Appends to log/rank-R.jsonl in the work folder. A log that cannot be written is no error.
class PartsLog {
 public:
  PartsLog(const WorkFolder& folder, int rank);

  using Start = std::chrono::steady_clock::time_point;
  static Start start() { return std::chrono::steady_clock::now(); }
  /// Notes that a part is whole: its triangles, pieces, the bytes of its file, and the resident
  /// memory of this process, also its peak.
  void part(Start start, std::uint64_t part, std::uint64_t triangles, std::uint64_t pieces,
            std::uint64_t bytes);

 private:
  std::ofstream file_;
  int rank_;
};

}  // namespace voxdag
