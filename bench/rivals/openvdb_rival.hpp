#pragma once
/// OpenVDB: casts voxdag's rays at voxdag's voxels. Runs a separate program
/// (bench/rivals/rival_openvdb_trace.cpp), so that voxdag does not link OpenVDB.
#include <filesystem>
#include <string>
#include <vector>

#include "bench/report/scratch_folder.hpp"
#include "bench/rivals/rival.hpp"
#include "voxdag/layout/voxel_set.hpp"

namespace voxdag {

/// Takes a sample of each set. One run of the program casts all samples, because it is slow to
/// start.
class OpenVdbRival : public Rival {
 public:
  /// `program` is rival_openvdb_trace, `vdag` the file of `voxels`.
  OpenVdbRival(std::string program, std::filesystem::path vdag, const VoxelSet& voxels);

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
  std::filesystem::path vdag_;
  VoxelSet voxels_;
  ScratchFolder folder_;
  std::vector<Sample> samples_;
};

}  // namespace voxdag
