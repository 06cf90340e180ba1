#pragma once
/// Who casts the rays of `voxdag bench trace`: this library, and others beside it.
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/trace/trace_rays.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Casts rays [first, last) of a set that it was prepared for; hits[i] becomes 1 where ray i meets
/// something. Called from many threads at once.
struct TraceRunner {
  std::string name;
  std::function<void(std::size_t first, std::size_t last, std::uint8_t* hits)> cast;
  /// Work for the whole set that counts as its time, before the rays; may be empty.
  std::function<void()> before;
  /// Instead of these: casts the whole set, alone, and returns the seconds that count.
  std::function<double(std::uint8_t* hits)> cast_set{};
};

/// Embree's triangles of the same mesh. Only where the program was built with Embree.
class EmbreeRival {
 public:
  explicit EmbreeRival(Mesh mesh);
  ~EmbreeRival();
  EmbreeRival(const EmbreeRival&) = delete;
  EmbreeRival& operator=(const EmbreeRival&) = delete;

  static bool is_available();

  /// "embree_single" and "embree_packet16" on these rays, which are converted now. Packets are of
  /// 16 rays that follow each other; for each of the ways that Embree has for coherent rays and for
  /// others there is one runner of that name. Valid until the next call.
  std::vector<TraceRunner> prepare(const Grid& grid, RayClass rays, std::span<const CastRay> casts);

 private:
  class Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace voxdag
