#pragma once
/// Opens the DAG that a page of the viewer shows.
#include <cstdint>
#include <memory>
#include <string>

#include "cli/reduced_dag.hpp"
#include "cli/session.hpp"
#include "viewer/scene/scene_bytes.hpp"
#include "voxdag/file/model/scene_model.hpp"

namespace voxdag::cli {

struct ShownSceneArguments {
  DagReduction reduction;
  std::uint64_t memory_limit = 0;
  bool for_edits = false;  ///< read() makes a DAG without voxels seeded().
};

/// A scene with the memory that it refers to. Move-only.
class ShownScene {
 public:
  /// Opens a plain file of any size at once, as open_scene_bytes() does. Reads a compact one with
  /// read() and tells the user so. Throws Error(path, place, reason), also for an ESVO.
  static ShownScene open(const std::string& path, const ShownSceneArguments& arguments,
                         Session& session);
  /// Reads a file into memory, checks all of it, and reduces it as `arguments` says. Throws what
  /// DagModel and ReducedDag throw, and Error for an ESVO. `form` is that of bytes().
  static ShownScene read(const std::string& path, const ShownSceneArguments& arguments,
                         AttributeForm form, Session& session);

  const SceneBytes& bytes() const { return *bytes_; }
  /// Returns the DAG of a scene from read().
  const ReducedDag& dag() const { return *dag_; }
  /// Returns what counts the memory of a scene from read().
  MemoryBudget* memory() const { return memory_.get(); }
  /// Returns whether read() made the DAG seeded().
  bool is_seeded() const { return is_seeded_; }
  /// Returns the number of voxels of a scene from read().
  std::uint64_t voxels() const { return dag_->metadata().counts.voxels; }

 private:
  std::unique_ptr<MemoryBudget> memory_;  // The members below count their memory here.
  std::unique_ptr<DagModel> file_;
  std::unique_ptr<ReducedDag> dag_;
  MemoryReservation coded_;
  std::unique_ptr<SceneBytes> bytes_;
  bool is_seeded_ = false;
};

}  // namespace voxdag::cli
