#include "lab/rays/trace_measure.hpp"

#include <algorithm>
#include <chrono>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag::lab {
namespace {

double cast_all(const TraceRunner& runner, std::size_t count, std::uint8_t* hits) {
  constexpr std::size_t kBlock = 8192;  // a multiple of packets and ray windows
  if (runner.cast_set) return runner.cast_set(hits);
  const auto start = std::chrono::steady_clock::now();
  if (runner.before) runner.before();
  parallel_for((count + kBlock - 1) / kBlock, [&](std::size_t block) {
    runner.cast(block * kBlock, std::min((block + 1) * kBlock, count), hits);
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::vector<Measured> measure(const std::vector<TraceRunner>& runners, std::size_t count,
                              int repeat) {
  std::vector<Measured> measured(runners.size());
  for (Measured& m : measured) m.hits.resize(count);
  for (int turn = 0; turn <= repeat; ++turn)
    for (std::size_t i = 0; i < runners.size(); ++i) {
      const double seconds = cast_all(runners[i], count, measured[i].hits.data());
      if (turn > 0) measured[i].seconds = std::min(measured[i].seconds, seconds);
    }
  return measured;
}

std::size_t agreeing(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] == b[i] ? 1 : 0;
  return count;
}

std::size_t hits_at_same_place(const Grid& grid, std::span<const CastRay> rays,
                               const TraceRunner& a, const TraceRunner& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double t = static_cast<double>(a.closest_t(i)), u = static_cast<double>(b.closest_t(i));
    const Vec3d step = to_world_ray(grid, rays[i].ray).direction * (1 / grid.voxel_size);
    const bool is_near = std::abs(t - u) * std::sqrt(dot(step, step)) <= 0.01;
    count += is_near || (std::isinf(t) && std::isinf(u)) ? 1 : 0;
  }
  return count;
}

std::vector<CastRay> sample_of(std::span<const CastRay> rays, std::size_t most) {
  constexpr std::size_t kRun = 64;
  const std::size_t step = std::max<std::size_t>(1, rays.size() / most);
  std::vector<CastRay> sample;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (i / kRun % step == 0) sample.push_back(rays[i]);
  return sample;
}

}  // namespace voxdag::lab
