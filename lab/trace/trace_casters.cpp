#include "lab/trace/trace_casters.hpp"

#include "lab/rays/caster_runner.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/trace/scalar_caster.hpp"
#include "voxdag/trace/svdag_nodes.hpp"
#include "voxdag/trace/top_cast.hpp"

namespace voxdag::lab {
namespace {

/// Counts the bytes that a walk through the paper's layout reads.
class ByteCountingNodes : public SvdagNodes {
 public:
  using Path = NodePath<ByteCountingNodes>;
  ByteCountingNodes(const SvdagNodes& nodes, std::uint64_t& steps, std::uint64_t& bytes)
      : SvdagNodes(nodes), steps_(&steps), bytes_(&bytes) {}

  void on_step() const { ++*steps_; }
  std::uint32_t child_mask(Node node, int level) const {
    *bytes_ += level < levels() - 2 ? 4u : level == levels() - 2 ? 8u : 0u;
    return SvdagNodes::child_mask(node, level);
  }
  Node child(Node node, int level, int index) const {
    *bytes_ += level < levels() - 2 ? 4u : 0u;
    return SvdagNodes::child(node, level, index);
  }

 private:
  std::uint64_t *steps_, *bytes_;
};

/// Casts the rays and returns the means per ray of the counters `steps` and `read` of `nodes`.
template <class Nodes>
WalkCost cost_of(const Nodes& nodes, std::span<const CastRay> casts, const std::uint64_t& steps,
                 const std::uint64_t& read) {
  for (const CastRay& ray : casts) {
    CellHit cell;
    cast(nodes, ray.ray, ray.stop, cell);
  }
  const auto count = static_cast<double>(casts.size());
  return {static_cast<double>(steps) / count, static_cast<double>(read) / count};
}

/// Casts one ray at a time at the layout that files store.
class PaperScalarLayout : public TraceLayout {
 public:
  explicit PaperScalarLayout(const SvdagView& dag) : dag_(dag) {}

  std::uint64_t bytes() const override { return dag_.bytes(); }
  DeviceLayout device_layout() const override { return DeviceLayout::kPaper; }
  TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const override {
    return runner_of(ScalarCaster<SvdagNodes>(SvdagNodes(dag_)), rays, casts);
  }
  WalkCost cost(std::span<const CastRay> casts) const override {
    std::uint64_t steps = 0, read = 0;
    const ByteCountingNodes nodes(SvdagNodes(dag_), steps, read);
    return cost_of(nodes, casts, steps, read);
  }

 private:
  SvdagView dag_;
};

/// Casts packets of rays at the layout that files store, with boxes (BoundedDag).
class PaperLayout : public PaperScalarLayout {
 public:
  explicit PaperLayout(const SvdagView& dag) : PaperScalarLayout(dag), dag_(SvdagNodes(dag)) {}

  std::uint64_t bytes() const override { return PaperScalarLayout::bytes() + dag_.bytes(); }
  std::uint64_t device_bytes() const override { return PaperScalarLayout::bytes(); }
  TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const override {
    return runner_of(PacketCaster(dag_), rays, casts);
  }

 private:
  BoundedDag dag_;
};

/// Counts the bytes that a walk reads through a DAG with a grid.
class ByteCountingTopNodes : public TopNodes {
 public:
  ByteCountingTopNodes(const TopNodes& nodes, std::uint64_t& steps, std::uint64_t& bytes)
      : TopNodes(nodes), steps_(&steps), bytes_(&bytes) {}

  void on_step() const { ++*steps_; }
  void on_read(std::uint32_t bytes) const { *bytes_ += bytes; }

 private:
  std::uint64_t *steps_, *bytes_;
};

/// Casts one ray at a time at the layout that files store, with a dense grid above it.
class TopLayout : public PaperScalarLayout {
 public:
  explicit TopLayout(const SvdagView& dag)
      : PaperScalarLayout(dag),
        grid_(make_top_grid(dag, top_level(dag.levels))),
        nodes_(dag, grid_.view()) {}

  std::uint64_t bytes() const override {
    return PaperScalarLayout::bytes() + grid_.cells.size() * sizeof(std::uint64_t);
  }
  DeviceLayout device_layout() const override { return DeviceLayout::kTop; }
  TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const override {
    return runner_of(ScalarCaster<TopNodes>(nodes_), rays, casts);
  }
  WalkCost cost(std::span<const CastRay> casts) const override {
    std::uint64_t steps = 0, read = 0;
    return cost_of(ByteCountingTopNodes(nodes_, steps, read), casts, steps, read);
  }

 private:
  TopGrid grid_;
  TopNodes nodes_;
};

/// Counts the bytes that a walk through an ESVO reads.
template <class Nodes>
class ByteCountingEsvoNodes : public Nodes {
 public:
  ByteCountingEsvoNodes(const EsvoView& esvo, std::uint64_t& steps, std::uint64_t& bytes)
      : Nodes(esvo), steps_(&steps), bytes_(&bytes) {}

  void on_step() const { ++*steps_; }
  void on_read(std::uint32_t bytes) const { *bytes_ += bytes; }

 private:
  std::uint64_t *steps_, *bytes_;
};

/// Casts packets at an ESVO, with its contours or as cubes.
template <class Nodes>
class EsvoTraceLayout : public TraceLayout {
 public:
  explicit EsvoTraceLayout(const EsvoView& esvo) : esvo_(esvo) {}

  std::uint64_t bytes() const override { return esvo_.slot_count * 8; }
  DeviceLayout device_layout() const override {
    return Nodes::kWithContours ? DeviceLayout::kContours : DeviceLayout::kCubes;
  }
  TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const override {
    return runner_of(PacketCaster(Nodes(esvo_)), rays, casts);
  }
  WalkCost cost(std::span<const CastRay> casts) const override {
    std::uint64_t steps = 0, read = 0;
    const ByteCountingEsvoNodes<Nodes> nodes(esvo_, steps, read);
    return cost_of(nodes, casts, steps, read);
  }

 private:
  EsvoView esvo_;
};

const std::vector<std::string> kDagLayouts{"paper", "paper_scalar", "top"};
/// Casts one ray at a time at an ESVO, with its contours or as cubes.
template <class Nodes>
class EsvoScalarLayout : public EsvoTraceLayout<Nodes> {
 public:
  explicit EsvoScalarLayout(const EsvoView& esvo) : EsvoTraceLayout<Nodes>(esvo), nodes_(esvo) {}

  TraceRunner runner(RayClass rays, std::span<const CastRay> casts) const override {
    return runner_of(ScalarCaster<Nodes>(nodes_), rays, casts);
  }

 private:
  Nodes nodes_;
};

const std::vector<std::string> kEsvoLayouts{"contours", "contours_scalar", "cubes", "cubes_scalar"};

}  // namespace

std::vector<std::string> trace_layouts() {
  std::vector<std::string> all = kDagLayouts;
  all.insert(all.end(), kEsvoLayouts.begin(), kEsvoLayouts.end());
  return all;
}

std::vector<std::string> trace_layouts(const VoxelSet& voxels) {
  return voxels.esvo() != nullptr ? kEsvoLayouts : kDagLayouts;
}

std::unique_ptr<TraceLayout> make_trace_layout(const std::string& name, const VoxelSet& voxels) {
  if (const EsvoView* esvo = voxels.esvo()) {
    if (name == "contours") return std::make_unique<EsvoTraceLayout<ContourNodes>>(*esvo);
    if (name == "contours_scalar") return std::make_unique<EsvoScalarLayout<ContourNodes>>(*esvo);
    if (name == "cubes_scalar") return std::make_unique<EsvoScalarLayout<EsvoNodes>>(*esvo);
    if (name == "cubes") return std::make_unique<EsvoTraceLayout<EsvoNodes>>(*esvo);
    throw Error("there is no layout \"" + name + "\" of an ESVO");
  }
  const SvdagView& dag = *voxels.dag();
  if (name == "paper") return std::make_unique<PaperLayout>(dag);
  if (name == "paper_scalar") return std::make_unique<PaperScalarLayout>(dag);
  if (name == "top") return std::make_unique<TopLayout>(dag);
  throw Error("there is no layout \"" + name + "\" of a DAG");
}

}  // namespace voxdag::lab
