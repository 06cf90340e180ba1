#include "cli/reduced_dag.hpp"

#include <fmt/core.h>

#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/verify_vdag.hpp"

namespace voxdag::cli {
namespace {

/// Throws Error unless the metadata of the file describes its attributes.
void check_metadata(const VdagMetadata& metadata, const DagAttributesView& attributes,
                    const std::string& path) {
  try {
    compare_attributes(metadata.attributes, attributes);
  } catch (const Error& error) {
    throw error.in_file(path);
  }
}

}  // namespace

std::vector<Option> add_reduction_options(const Command& command, DagReduction& reduction) {
  const Option levels = command.optional_number<int>(
      "--levels", reduction.levels, NumberRange::whole(kMinLevels, kMaxLevels), "L",
      "Make the grid coarser, 2^L voxels a side: a voxel is set if one in it was");
  const auto has_levels = [&reduction] { return reduction.levels.has_value(); };
  const Option color_bound =
      command
          .number("--color-bound", reduction.bounds.color_bound, NumberRange::from(0, 1),
                  "DIFFERENCE",
                  "With --levels: how far a colour may change when the coarser colours are encoded "
                  "again, in the units of build (0: not at all)")
          .only_if(has_levels, "without --levels");
  const Option normal_bound =
      command
          .number("--normal-bound", reduction.bounds.normal_bound_degrees,
                  NumberRange::from(0, 180), "DEGREES",
                  "With --levels: how far a normal may turn when it is encoded again (0: not at "
                  "all)")
          .only_if(has_levels, "without --levels");
  const Option drop = command.flag("--drop-attributes", reduction.drop_attributes,
                                   "Leave out colours, normals and material ids");
  return {levels, color_bound, normal_bound, drop};
}

MemoryReservation reserve_coded(const DagAttributesView& attributes, AttributeForm form,
                                MemoryBudget* memory) {
  if (form == AttributeForm::kPages) return {};
  // The coded bytes, and as many again while their array grows.
  return MemoryReservation(memory, 2 * (attributes.colors.bytes() + attributes.normals.bytes() +
                                        attributes.materials.bytes()));
}

ReducedDag::ReducedDag(const DagModel& file, const std::string& path, const DagReduction& reduction,
                       Work work)
    : dag_(file.view()), metadata_(file.metadata()) {
  if (!reduction.drop_attributes) attributes_ = file.attributes();
  if (attributes_.is_empty())
    metadata_.attributes = {};
  else
    check_metadata(metadata_, attributes_, path);
  const int levels = reduction.levels.value_or(dag_.levels);
  if (levels > dag_.levels)
    throw Error(path, "",
                fmt::format("has {} levels, {} voxels a side: it cannot get {} levels", dag_.levels,
                            std::int64_t{1} << dag_.levels, levels));
  if (levels == dag_.levels) return;
  coarse_ = coarsen(dag_, levels, work);
  dag_ = coarse_.view();
  metadata_ = coarser_metadata(metadata_, dag_);
  if (attributes_.is_empty()) return;
  coarse_attributes_ = coarsen_attributes({file.view(), attributes_}, dag_, reduction.bounds, work);
  describe_coarser(metadata_.attributes, levels, reduction.bounds);
  attributes_ = coarse_attributes_.view();
  memory_ = MemoryReservation(work.memory, coarse_attributes_.bytes());
}

}  // namespace voxdag::cli
