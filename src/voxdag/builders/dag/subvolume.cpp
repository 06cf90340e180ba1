// The entry to the depth-first recursion. Compiled once for each instruction set; the best that the
// machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxdag/builders/dag/subvolume.cpp"
#include "voxdag/builders/dag/subvolume.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "voxdag/builders/dag/streamed_cells-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace voxdag {
namespace HWY_NAMESPACE {
namespace {

template <class Sink>
NodeId build(SubvolumeContext<Sink>& context, const SubvolumeJob& job) {
  if (job.triangles.empty()) return kNoNode;
  context.classified.clear();
  context.triangles.resize(job.triangles.size());
  std::copy(job.triangles.begin(), job.triangles.end(), context.triangles.begin());
  const Cell cell = StreamedCells<Sink>(context, job.origin)
                        .cell({0, 0, 0}, job.log2_size, 0, job.triangles.size());
  return intern_cell(context.sink, context.levels, job.log2_size, cell);
}

}  // namespace

NodeId build_dag(SubvolumeContext<DagSink>& context, const SubvolumeJob& job) {
  return build(context, job);
}
NodeId build_tree(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job) {
  return build(context, job);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxdag
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxdag {

HWY_EXPORT(build_dag);
HWY_EXPORT(build_tree);

NodeId build_subvolume(SubvolumeContext<DagSink>& context, const SubvolumeJob& job) {
  return HWY_DYNAMIC_DISPATCH(build_dag)(context, job);
}
NodeId build_subvolume(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job) {
  return HWY_DYNAMIC_DISPATCH(build_tree)(context, job);
}

}  // namespace voxdag
#endif
