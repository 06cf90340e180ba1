#pragma once
/// The options that make a DAG coarser or leave out its attributes, and the DAG that they make.
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/attribute_form.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"

namespace voxdag::cli {

struct DagReduction {
  std::optional<int> levels;  ///< None: those of the file.
  bool drop_attributes = false;
  CoarsenBounds bounds;
};

/// Adds --levels, --color-bound, --normal-bound and --drop-attributes. Returns them.
std::vector<Option> add_reduction_options(const Command& command, DagReduction& reduction);

/// Reserves the memory that a writer takes for attributes in this form, besides the attributes.
/// Throws OverMemory.
MemoryReservation reserve_coded(const DagAttributesView& attributes, AttributeForm form,
                                MemoryBudget* memory);

/// A DAG with its metadata and attributes. Refers to its file, which must outlive it, or owns what
/// the reduction changed. Move-only; views stay valid when it is moved.
class ReducedDag {
 public:
  /// `path` is the file's name, for errors. Throws Error if `reduction` asks for more levels than
  /// the file has, or if the file's metadata does not describe its attributes; OverMemory and
  /// Cancelled.
  ReducedDag(const DagModel& file, const std::string& path, const DagReduction& reduction,
             Work work);

  const SvdagView& dag() const { return dag_; }
  const DagAttributesView& attributes() const { return attributes_; }
  const VdagMetadata& metadata() const { return metadata_; }

 private:
  SvdagView dag_;
  DagAttributesView attributes_;
  VdagMetadata metadata_;
  Svdag coarse_;
  DagAttributes coarse_attributes_;
  MemoryReservation memory_;  ///< Counts `coarse_attributes_`.
};

}  // namespace voxdag::cli
