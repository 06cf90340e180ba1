#pragma once
/// What the programs rival_*_trace have in common: arguments, files of rays and hits, repeated
/// casts.
///
///   rival_NAME_trace FILE.vdag THREADS REPEAT RAYS.npy...
///
/// RAYS.npy is a float32 array of shape (N, 8), as for `voxdag trace`. The program casts each
/// file's rays at the voxels of FILE.vdag, writes RAYS.npy.hits, one byte for each ray (1 for a
/// hit), and prints {"seconds": [...], "bytes": N}: the fastest of REPEAT casts of each file, and
/// the size of the structure that holds the voxels.
#include <functional>
#include <span>

#include "voxdag/file/vdag_file.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Casts world rays, sets 1 in `hits` for each that hits a voxel, else 0, and returns the seconds
/// of the casts alone.
using CastRays = std::function<double(std::span<const Ray> rays, std::span<char> hits)>;

/// A rival's structure that holds the voxels of a file.
struct TraceProgram {
  CastRays cast_rays;
  std::uint64_t bytes = 0;
};
/// Makes the structure. Casts on `threads` threads.
using MakeTraceProgram = std::function<TraceProgram(const VdagFile& file, int threads)>;

/// Runs a program `name` and returns its exit status. Prints errors.
int run_trace_program(int argc, char** argv, const char* name, const MakeTraceProgram& make);

}  // namespace voxdag
