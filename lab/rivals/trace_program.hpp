#pragma once
/// Runs the programs rival_NAME_trace, which cast rays for `voxdag bench trace`:
///
///   rival_NAME_trace FILE.vdag THREADS REPEAT RAYS.npy...
///
/// RAYS.npy is a float32 array of shape (N, 8), as for `voxdag trace`. The program casts each
/// file's rays at the voxels of FILE.vdag, writes RAYS.npy.hits, one byte for each ray (1 for a
/// hit), and prints {"seconds": [...], "bytes": B}: the fastest of REPEAT casts of each file, and
/// the size of the structure that holds the voxels.
#include <functional>
#include <span>

#include "voxdag/file/vdag_file.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag::lab {

/// Casts world rays, sets 1 in `hits` for each that hits a voxel, else 0, and returns the seconds
/// of the casts alone.
using CastRays = std::function<double(std::span<const Ray> rays, std::span<char> hits)>;

/// A rival's structure that holds the voxels of a file.
struct TraceProgram {
  CastRays cast_rays;
  std::uint64_t bytes = 0;
};
/// Makes the structure of a file. Its casts run on `threads` threads.
using MakeTraceProgram = std::function<TraceProgram(const VdagFile& file, int threads)>;

/// Runs the program `name` with the arguments of main(), prints errors, and returns the exit
/// status.
int run_trace_program(int argc, char** argv, const char* name, const MakeTraceProgram& make);

/// A ray in units of voxels, with the world ray's t. Voxel (i,j,k) is the cube with its lower
/// corner at (i,j,k).
struct VoxelRay {
  Vec3d origin, direction;
};

VoxelRay to_voxels(const Grid& grid, const Ray& ray);

}  // namespace voxdag::lab
