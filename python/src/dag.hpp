#pragma once
/// The class Dag of the module.
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <optional>

#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/layout/look.hpp"
#include "voxdag/model/dag_model.hpp"

namespace voxdag::python {

/// A DAG that Python objects share. It never changes, so several threads may use it.
class Dag {
 public:
  explicit Dag(DagModel model) : model_(std::move(model)) {}

  const DagModel& model() const { return model_; }
  SvdagView view() const { return model_.view(); }
  const Grid& grid() const { return model_.grid(); }
  /// Returns the attributes as a look; empty if there are none.
  LookView look() const { return ColoredDagView{view(), model_.attributes()}; }

  /// Returns the structure that rays need. The first call makes it.
  const CpuScene& scene() const {
    const std::lock_guard lock(making_);
    if (!scene_) scene_.emplace(VoxelSet(view()));
    return *scene_;
  }

 private:
  DagModel model_;
  mutable std::mutex making_;
  mutable std::optional<CpuScene> scene_;
};

using DagPointer = std::shared_ptr<Dag>;
using DagClass = pybind11::class_<Dag, DagPointer>;

/// Add the functions that make DAGs, and the methods of Dag, to the module.
void add_makers(pybind11::module_& module);
void add_rays(DagClass& dag);
void add_queries(DagClass& dag);
void add_edits(DagClass& dag);
void add_pictures(DagClass& dag);

}  // namespace voxdag::python
