#include "lab/compact_rays/compact_rays.hpp"

#include <chrono>

#include "lab/rays/caster_runner.hpp"
#include "lab/rays/trace_measure.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/cpu/packets/in_place_nodes.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::lab {
namespace {

class Watch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns a runner that casts single rays at the compact form.
TraceRunner single_rays(const InPlaceDag& dag, RayClass rays, std::span<const CastRay> casts) {
  TraceRunner runner;
  runner.name = "compact";
  runner.cast = [dag, rays, casts](std::size_t first, std::size_t last, std::uint8_t* hits) {
    runner_of(ScalarCaster<InPlaceNodes>(InPlaceNodes(dag, dag.cache())), rays, casts)
        .cast(first, last, hits);
  };
  return runner;
}

class Bench {
 public:
  Bench(const SvdagView& dag, const Grid& grid, const CompactRaysPlan& plan, Progress& progress)
      : dag_(dag),
        grid_(grid),
        plan_(plan),
        progress_(progress),
        plain_(SvdagNodes(dag)),
        plain_packets_(BoundedDag(SvdagNodes(dag))) {}

  CompactRaysResults run(const std::string& scene) {
    results_.scene = scene;
    results_.levels = dag_.levels;
    results_.plain_bytes = dag_.bytes();
    results_.nodes = count_svdag(dag_).dag_nodes();
    record();
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
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      counted_[c] = sample_of(casts_[c], plan_.most_counted);
      results_.plain_touched[c] = touched_memory(dag_, counted_[c]);
    }
  }

  void measure_tables(int tables) {
    CompactRaysPoint point;
    point.tables = tables;
    const Watch encoding;
    const CompactSvdag compact = encode_svdag(dag_, {.tables = tables}, &progress_);
    point.encode_seconds = encoding.seconds();
    const Watch decoding;
    if (decode_svdag(compact.view(), &progress_).nodes.size() != dag_.node_words())
      throw Error("the compact form does not give the DAG back");
    point.decode_seconds = decoding.seconds();
    point.bytes = compact_head(compact).size() + compact.words().size() * 4;
    // Single rays and packets get caches of their own.
    const Watch opening;
    const InPlaceDag for_single(compact.view());
    point.open_seconds = opening.seconds();
    const InPlaceDag for_packets(compact.view());
    point.open_bytes = for_single.bytes();
    for (std::size_t c = 0; c < kCompactRayClassCount; ++c) {
      const RayClass rays = kCompactRayClasses[c];
      const std::span<const CastRay> casts = casts_[c];
      const std::uint64_t single_before = for_single.decoded_units(),
                          packets_before = for_packets.decoded_units();
      const std::vector<Measured> measured =
          measure({runner_of(plain_, rays, casts), runner_of(plain_packets_, rays, casts),
                   single_rays(for_single, rays, casts),
                   runner_of(PacketCaster<InPlaceDag>(for_packets), rays, casts)},
                  casts.size(), plan_.repeat);
      for (const Measured& runner : measured)
        if (agreeing(runner.hits, measured[0].hits) != casts.size())
          throw Error("rays at the compact form hit other voxels than those at the plain form");
      const double all_rays = static_cast<double>(casts.size()) * (plan_.repeat + 1);
      CompactRaysTimes& times = point.times[c];
      times.plain_seconds = measured[0].seconds;
      times.plain_packet_seconds = measured[1].seconds;
      times.seconds = measured[2].seconds;
      times.packet_seconds = measured[3].seconds;
      times.units_per_ray =
          static_cast<double>(for_single.decoded_units() - single_before) / all_rays;
      times.packet_units_per_ray =
          static_cast<double>(for_packets.decoded_units() - packets_before) / all_rays;
      point.touched[c] = touched_memory(compact.view(), counted_[c]);
    }
    results_.cache_bytes = for_packets.cache_bytes_per_thread();
    results_.points.push_back(point);
  }

  const SvdagView& dag_;
  const Grid& grid_;
  const CompactRaysPlan& plan_;
  Progress& progress_;
  CompactRaysResults results_;
  std::vector<CastRay> casts_[kCompactRayClassCount], counted_[kCompactRayClassCount];
  ScalarCaster<SvdagNodes> plain_;
  PacketCaster<BoundedDag> plain_packets_;
};

}  // namespace

CompactRaysResults bench_compact_rays(const std::string& scene, const SvdagView& dag,
                                      const Grid& grid, const CompactRaysPlan& plan,
                                      Progress& progress) {
  if (dag.levels < 4) throw Error("rays at the compact form need a grid of 16³ voxels or more");
  return Bench(dag, grid, plan, progress).run(scene);
}

}  // namespace voxdag::lab
