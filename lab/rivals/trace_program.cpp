#include "lab/rivals/trace_program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag::lab {
namespace {

std::vector<Ray> read_rays(const char* path) {
  NpyReader reader(path, "<f4", {8}, sizeof(float));
  std::vector<Ray> rays(reader.rows());
  reader.read_rows(rays.data(), rays.size());
  return rays;
}

void write_hits(const std::string& path, const std::vector<char>& hits) {
  std::ofstream out(path, std::ios::binary);
  out.write(hits.data(), static_cast<std::streamsize>(hits.size()));
  if (!out.flush()) throw Error(path, "", "cannot be written");
}

void trace(int argc, char** argv, const MakeTraceProgram& make) {
  const VdagFile file(argv[1]);
  const int threads = std::max(std::atoi(argv[2]), 1), repeat = std::max(std::atoi(argv[3]), 1);
  const TraceProgram program = make(file, threads);
  std::string seconds;
  for (int i = 4; i < argc; ++i) {
    const std::vector<Ray> rays = read_rays(argv[i]);
    std::vector<char> hits(rays.size());
    double best = HUGE_VAL;
    for (int turn = 0; turn <= repeat; ++turn) {  // the first turn warms up
      const double took = program.cast_rays(rays, hits);
      if (turn > 0) best = std::min(best, took);
    }
    write_hits(std::string(argv[i]) + ".hits", hits);
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", best);
    seconds += (seconds.empty() ? "" : ", ") + std::string(text);
  }
  std::printf("{\"seconds\": [%s], \"bytes\": %llu}\n", seconds.c_str(),
              static_cast<unsigned long long>(program.bytes));
}

}  // namespace

int run_trace_program(int argc, char** argv, const char* name, const MakeTraceProgram& make) try {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s FILE.vdag THREADS REPEAT RAYS.npy...\n", name);
    return 2;
  }
  trace(argc, argv, make);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s: %s\n", name, error.what());
  return 1;
}

VoxelRay to_voxels(const Grid& grid, const Ray& ray) {
  return {grid.to_grid(static_cast<Vec3d>(ray.origin)),
          static_cast<Vec3d>(ray.direction) * (1 / grid.voxel_size)};
}

}  // namespace voxdag::lab
