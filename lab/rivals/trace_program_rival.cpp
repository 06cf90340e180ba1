#include "lab/rivals/trace_program_rival.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "lab/rays/trace_measure.hpp"
#include "lab/runs/child.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/trace/ray.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag::lab {
namespace {

void write_rays(const std::filesystem::path& file, const Grid& grid,
                const std::vector<CastRay>& casts) {
  std::vector<Ray> rays;
  rays.reserve(casts.size());
  for (const CastRay& cast : casts) {
    const WorldRay world = to_world_ray(grid, cast.ray);
    rays.push_back({static_cast<Vec3f>(world.origin), world.t_min,
                    static_cast<Vec3f>(world.direction), world.t_max});
  }
  NpyWriter writer(file, "<f4", {8}, sizeof(float), rays.size());
  writer.write_rows(rays.data(), rays.size());
  writer.commit();
}

/// Returns 1 for each ray that hits a voxel, else 0.
std::vector<std::uint8_t> hits_of(const VoxelSet& voxels, const std::vector<CastRay>& casts) {
  constexpr std::size_t kBlock = 4096;
  std::vector<std::uint8_t> hits(casts.size());
  visit_nodes(voxels, [&](const auto& nodes) {
    parallel_for((casts.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, casts.size()); ++i) {
        CellHit cell;
        hits[i] = cast(nodes, casts[i].ray, StopAtVoxels{}, cell) ? 1 : 0;
      }
    });
  });
  return hits;
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Returns the absolute path of a program that is given by its path, because it runs in another
/// folder; a bare name is looked up in PATH.
std::string absolute_program(const std::string& program) {
  return program.find('/') == std::string::npos ? program
                                                : std::filesystem::absolute(program).string();
}

}  // namespace

TraceProgramRival::TraceProgramRival(std::string name, const std::string& program,
                                     std::size_t sample_rays, std::filesystem::path vdag,
                                     const VoxelSet& voxels)
    : Rival(std::move(name)),
      program_(absolute_program(program)),
      sample_rays_(sample_rays),
      vdag_(std::move(vdag)),
      voxels_(voxels) {}

std::vector<TraceRunner> TraceProgramRival::prepare(const Grid& grid, const RaySet& set) {
  const std::vector<CastRay> casts = sample_of(set.casts, sample_rays_);
  Sample sample;
  sample.rays_class = set.rays_class;
  sample.set_size = static_cast<double>(set.casts.size());
  sample.rays_file = folder_.path() / (std::to_string(samples_.size()) + ".npy");
  sample.hits = hits_of(voxels_, casts);
  write_rays(sample.rays_file, grid, casts);
  samples_.push_back(std::move(sample));
  return {};
}

std::vector<RivalTime> TraceProgramRival::cast_all(int repeat, Progress& progress) {
  std::vector<std::string> command{program_, std::filesystem::absolute(vdag_),
                                   std::to_string(tbb::this_task_arena::max_concurrency()),
                                   std::to_string(repeat)};
  for (const Sample& sample : samples_) command.push_back(sample.rays_file);
  const ChildResult result = run_child(command, folder_.path(), 0, progress);
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  if (result.status != 0 || !json.is_object() ||
      json.value("seconds", json).size() != samples_.size())
    throw Error(program_, "", "failed: " + result.err.substr(0, result.err.find('\n')));
  std::vector<RivalTime> times;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    const double scale = sample.set_size / static_cast<double>(sample.hits.size());
    const auto same =
        static_cast<double>(agreeing(sample.hits, read_bytes(sample.rays_file.string() + ".hits")));
    times.push_back({sample.rays_class, json.at("seconds").at(i).get<double>() * scale,
                     same * scale, json.value("bytes", std::uint64_t{0})});
  }
  return times;
}

}  // namespace voxdag::lab
