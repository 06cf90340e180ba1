#include "bench/compact_rays/compact_rays.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <chrono>

#include "bench/rays/caster_runner.hpp"
#include "bench/rays/trace_measure.hpp"
#include "voxdag/compact/encode_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/cpu/decoded_cache.hpp"
#include "voxdag/layout/compact/compact_bytes.hpp"
#include "voxdag/layout/svdag_counts.hpp"

namespace voxdag {
namespace {

using Caches = tbb::enumerable_thread_specific<DecodedCache>;

class Watch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns a runner that casts at the compact form. Each thread keeps its cache from set to set.
TraceRunner compact_runner(const CompactSvdagView& compact, Caches& caches, RayClass rays,
                           std::span<const CastRay> casts) {
  TraceRunner runner;
  runner.name = "compact";
  runner.cast = [compact, &caches, rays, casts](std::size_t first, std::size_t last,
                                                std::uint8_t* hits) {
    const CompactSvdagNodes<DecodedCache> nodes(compact, caches.local());
    runner_of(ScalarCaster<CompactSvdagNodes<DecodedCache>>(nodes), rays, casts)
        .cast(first, last, hits);
  };
  return runner;
}

double decoded(const Caches& caches) {
  std::uint64_t count = 0;
  for (const DecodedCache& cache : caches) count += cache.decoded_units() + cache.decoded_bricks();
  return static_cast<double>(count);
}

class Bench {
 public:
  Bench(const SvdagView& dag, const Grid& grid, const CompactRaysPlan& plan, Progress& progress)
      : dag_(dag), grid_(grid), plan_(plan), progress_(progress) {}

  CompactRaysResults run(const std::string& scene) {
    results_.scene = scene;
    results_.levels = dag_.levels;
    results_.plain_bytes = dag_.bytes();
    results_.nodes = count_svdag(dag_).dag_nodes();
    results_.cache_bytes = DecodedCache::bytes();
    record();
    measure_plain();
    for (const int tables : plan_.tables) measure_tables(tables);
    return std::move(results_);
  }

 private:
  void record() {
    const double aspect = static_cast<double>(plan_.rays.width) / plan_.rays.height;
    for (const View& view : bench_views(dag_, grid_, aspect, plan_.views)) {
      BeamPass beams(dag_, grid_, picture_options(dag_, grid_, view, plan_.rays));
      beams.run();
      const RecordedRays recorded = record_rays(dag_, beams, plan_.rays);
      for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
        const auto sample = sample_of(recorded.of(kCompactRayClasses[c]), plan_.most_rays);
        casts_[c].insert(casts_[c].end(), sample.begin(), sample.end());
        results_.rays[c] = casts_[c].size();
      }
    }
  }

  void measure_plain() {
    const ScalarCaster<SvdagNodes> scalar{SvdagNodes(dag_)};
    const PacketCaster<BoundedDag> packets{BoundedDag(SvdagNodes(dag_))};
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      const RayClass rays = kCompactRayClasses[c];
      const auto measured =
          measure({runner_of(scalar, rays, casts_[c]), runner_of(packets, rays, casts_[c])},
                  casts_[c].size(), plan_.repeat);
      results_.plain_seconds[c] = measured[0].seconds;
      results_.packet_seconds[c] = measured[1].seconds;
      hits_[c] = measured[0].hits;
    }
  }

  void measure_tables(int tables) {
    CompactRaysPoint point;
    point.tables = tables;
    const Watch encoding;
    const CompactSvdag compact = encode_svdag(dag_, {.tables = tables}, &progress_);
    point.encode_seconds = encoding.seconds();
    const Watch decoding;
    if (decode_svdag(compact.view(), nullptr, &progress_).nodes.size() != dag_.node_words())
      throw Error("the compact form does not give the DAG back");
    point.decode_seconds = decoding.seconds();
    point.bytes = compact_head(compact).size() + compact.words().size() * 4;
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      Caches caches;
      const std::size_t count = casts_[c].size();
      const auto measured =
          measure({compact_runner(compact.view(), caches, kCompactRayClasses[c], casts_[c])}, count,
                  plan_.repeat);
      if (agreeing(measured[0].hits, hits_[c]) != count)
        throw Error("rays at the compact form hit other voxels than those at the plain form");
      point.ray_seconds[c] = measured[0].seconds;
      point.units_per_ray[c] =
          decoded(caches) / static_cast<double>(count) / static_cast<double>(plan_.repeat + 1);
    }
    results_.points.push_back(point);
  }

  const SvdagView& dag_;
  const Grid& grid_;
  const CompactRaysPlan& plan_;
  Progress& progress_;
  CompactRaysResults results_;
  std::vector<CastRay> casts_[kCompactRayClassCount];
  std::vector<std::uint8_t> hits_[kCompactRayClassCount];
};

}  // namespace

CompactRaysResults bench_compact_rays(const std::string& scene, const SvdagView& dag,
                                      const Grid& grid, const CompactRaysPlan& plan,
                                      Progress& progress) {
  return Bench(dag, grid, plan, progress).run(scene);
}

}  // namespace voxdag
