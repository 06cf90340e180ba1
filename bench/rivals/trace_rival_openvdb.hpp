#pragma once
/// OpenVDB beside our casts: the same rays on the same voxels, in a program of its own
/// (bench/rival_openvdb_trace.cpp), so that nothing of it is in this one.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/report/scratch_folder.hpp"
#include "bench/trace/trace_rays.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// Collects sets of rays; the program, which is slow to begin, casts them all at once.
class OpenVdbRival {
 public:
  /// How long the rays of a set took, and which of them met something.
  struct Answer {
    double seconds = 0;
    std::vector<std::uint8_t> hits;
  };

  void add(const Grid& grid, std::span<const CastRay> casts);
  /// One answer for each set, in order. Throws Error where the program fails.
  std::vector<Answer> cast(const std::string& program, const std::filesystem::path& vdag,
                           int threads, int repeat, const Progress& progress) const;

 private:
  ScratchFolder folder_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace voxdag
