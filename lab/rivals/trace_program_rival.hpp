#pragma once
/// Casts voxdag's rays at voxdag's voxels with a separate program (trace_program.hpp), so that
/// voxdag does not link its libraries.
#include <filesystem>
#include <string>
#include <vector>

#include "lab/rivals/rival.hpp"
#include "lab/runs/scratch_folder.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag::lab {

/// Takes a sample of each set. One run of the program casts all samples, because it is slow to
/// start.
class TraceProgramRival : public Rival {
 public:
  /// `program` is rival_NAME_trace, `vdag` the file of `voxels`. A sample has about `sample_rays`
  /// rays, or all if there are fewer.
  TraceProgramRival(std::string name, const std::string& program, std::size_t sample_rays,
                    std::filesystem::path vdag, const VoxelSet& voxels);

  std::vector<TraceRunner> prepare(const Grid& grid, const RaySet& set) override;
  std::vector<RivalTime> cast_all(int repeat, Progress& progress) override;

 private:
  /// The sample of a set, and voxdag's hits.
  struct Sample {
    RayClass rays_class;
    double set_size = 0;
    std::filesystem::path rays_file;
    std::vector<std::uint8_t> hits;
  };

  std::string program_;
  std::size_t sample_rays_;
  std::filesystem::path vdag_;
  VoxelSet voxels_;
  ScratchFolder folder_;
  std::vector<Sample> samples_;
};

}  // namespace voxdag::lab
