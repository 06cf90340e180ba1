#pragma once
/// The class Dag of the module.
#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag::python {

/// The parts of a Dag or a Snapshot that rays and pictures need.
struct SceneParts {
  const Grid& grid;
  const CpuScene& scene;
  LookView look;
  const Presentation& presentation;
};

/// A DAG that Python objects share. It never changes, so several threads may use it.
class Dag {
 public:
  explicit Dag(DagModel model) : model_(std::move(model)) {
    const Presentation& shown = model_.metadata().presentation;
    if (!shown.home) model_.set_presentation(with_home(shown, view(), grid()));
  }

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
  SceneParts parts() const { return {grid(), scene(), look(), model_.metadata().presentation}; }
  ContactScene contacts() const { return {view(), grid()}; }

 private:
  DagModel model_;
  mutable std::mutex making_;
  mutable std::optional<CpuScene> scene_;
};

using DagPointer = std::shared_ptr<Dag>;
using DagClass = pybind11::class_<Dag, DagPointer>;

/// One version of a DAG that is being edited, for rays and pictures. It keeps the Dag that it began
/// with, because it reads values from it.
class Snapshot {
 public:
  Snapshot(DagPointer base, EditSnapshot snapshot)
      : base_(std::move(base)), snapshot_(std::move(snapshot)), scene_(snapshot_.view(), 0) {}

  SceneParts parts() const {
    return {base_->grid(), scene_, snapshot_.values(), base_->model().metadata().presentation};
  }
  ContactScene contacts() const { return {snapshot_.view(), base_->grid()}; }

 private:
  DagPointer base_;
  EditSnapshot snapshot_;
  CpuScene scene_;
};
using SnapshotClass = pybind11::class_<Snapshot, std::shared_ptr<Snapshot>>;

/// The first voxel of a box, and one past the last on each axis.
using Window = std::array<std::array<std::int32_t, 3>, 2>;

/// Returns the box of a window, by default the whole grid. Raises ValueError if it is empty or
/// reaches beyond the grid.
Box3i window_of(const Dag& dag, const std::optional<Window>& window);

/// Returns L for 2^L voxels a side. Raises ValueError unless it is a power of two from 4 to 2^20.
int levels_of(std::int64_t resolution);

/// Returns the number of "x", "y" or "z". Raises ValueError for other names.
int axis_of(const std::string& name);

/// Issues a UserWarning. Throws if Python turns it into an exception.
void warn(const std::string& text);

/// Add the functions that make DAGs, and the methods of Dag, to the module.
void add_makers(pybind11::module_& module);
/// Part of add_makers().
void add_importers(pybind11::module_& module);
void add_rays(DagClass& dag);
void add_rays(SnapshotClass& snapshot);
void add_contacts(DagClass& dag);
void add_contacts(SnapshotClass& snapshot);
void add_queries(DagClass& dag);
void add_edits(DagClass& dag);
void add_materials(DagClass& dag);
void add_channels(DagClass& dag);
void add_exports(DagClass& dag);
void add_pictures(DagClass& dag);
void add_pictures(SnapshotClass& snapshot);
/// Adds _LiveEdit, and Snapshot.
void add_live_edits(pybind11::module_& module);

}  // namespace voxdag::python
