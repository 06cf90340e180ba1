#pragma once
/// The shared counters (Ranks::next) from which the steps of a job take their tasks.

namespace voxdag {

enum JobCounter : int {
  kMeshCountsCounter,
  kMeshVerticesCounter,
  kMeshTrianglesCounter,
  kSegmentCounter,
  kPartCounter
};

}  // namespace voxdag
