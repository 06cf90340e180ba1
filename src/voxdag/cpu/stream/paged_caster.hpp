#pragma once
/// Casts rays at an ESVO that has only a few blocks in memory.
///
/// Source: M. Pharr et al., "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH
/// 1997: rays that reach a missing block wait there; when a block is loaded, all rays that wait for
/// it continue.
#include <algorithm>
#include <map>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/stream/streamed_image.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// ContourNodes that find the missing block of a ray and load blocks. For one thread.
class PagedNodes : public ContourNodes {
 public:
  explicit PagedNodes(BlockSource& source) : ContourNodes(source.view()), source_(&source) {}

  /// Returns the missing block into which the ray would have continued, or -1.
  template <class Stop>
  std::int64_t missing_block(const GridRay& ray, const Stop& stop, const EsvoHit& hit) const {
    return would_continue(view(), ray, stop, hit) ? source_->loaded().missing_block(hit.voxel.slot)
                                                  : -1;
  }
  void load(std::int64_t block) const { source_->load(static_cast<std::size_t>(block)); }

 private:
  BlockSource* source_;
};

/// Casts a ray. The result equals that of cast() with all blocks loaded.
template <class Stop>
bool cast(const PagedNodes& nodes, const GridRay& ray, const Stop& stop, EsvoHit& hit) {
  GridRay rest = ray;
  while (cast(static_cast<const ContourNodes&>(nodes), rest, stop, hit)) {
    const std::int64_t block = nodes.missing_block(rest, stop, hit);
    if (block < 0) return true;
    nodes.load(block);
    begin_at(hit, rest);
  }
  return false;
}

/// A caster (see trace/scalar_caster.hpp). It keeps all rays of a call in memory and reports hits
/// in the order in which blocks are loaded.
class PagedCaster {
 public:
  PagedCaster(const PagedNodes& nodes, Work work) : nodes_(nodes), work_(work) {}

  int levels() const { return nodes_.levels(); }

  template <class MakeRay, class OnResult>
  void closest(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run(count, make_ray, on_result);
  }

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run(count, make_ray,
        [&](int i, const GridRay&, const EsvoHit&, bool is_hit) { on_result(i, is_hit); });
  }

 private:
  template <class MakeRay, class OnResult>
  void run(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    struct Rest {
      CastRay cast;
      float t_min;  ///< The ray's original t_min.
    };
    std::vector<Rest> rays;
    rays.reserve(count);
    std::map<std::int64_t, std::vector<int>> waiting;  // rays that wait for each block
    const auto go_on = [&](int i) {
      Rest& rest = rays[i];
      GridRay& ray = rest.cast.ray;
      EsvoHit hit;
      const bool is_hit = cast(static_cast<const ContourNodes&>(nodes_), ray, rest.cast.stop, hit);
      const std::int64_t block = is_hit ? nodes_.missing_block(ray, rest.cast.stop, hit) : -1;
      if (block >= 0) {
        begin_at(hit, ray);
        waiting[block].push_back(i);
        return;
      }
      ray.t_min = rest.t_min;
      on_result(i, ray, hit, is_hit);
    };
    for (int i = 0; i < count; ++i) {
      const CastRay& made = make_ray(i);
      rays.push_back({made, made.ray.t_min});
    }
    for (int i = 0; i < count; ++i) go_on(i);
    while (!waiting.empty()) {
      work_.poll();
      const auto longest = std::max_element(
          waiting.begin(), waiting.end(),
          [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
      const auto [block, indices] = std::move(*longest);
      waiting.erase(longest);
      nodes_.load(block);
      for (const int i : indices) go_on(i);
    }
  }

  PagedNodes nodes_;
  Work work_;
};

}  // namespace voxdag
