#pragma once
/// Opens the DAG that a page of the viewer shows.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/scene_input.hpp"
#include "cli/session.hpp"
#include "viewer/scene/scene_bytes.hpp"

namespace voxdag {

struct ShownSceneArguments {
  std::optional<int> levels;  ///< Of a coarser grid to show; none: all.
  bool drop_attributes = false;
  std::uint64_t memory_limit = 0;
};

/// A scene and what it refers to. Move-only.
class ShownScene {
 public:
  /// Opens a file of any size at once: see open_scene_bytes(). Decodes a compact DAG, and says so.
  /// Throws Error(path, place, reason), also for an ESVO.
  static ShownScene open(const std::string& path, const ShownSceneArguments& arguments,
                         Session& session);
  /// Reads a file into memory and checks all of it. Coarsens it if `arguments` says so.
  static ShownScene read(const std::string& path, const ShownSceneArguments& arguments,
                         Session& session);

  const SceneBytes& bytes() const { return *bytes_; }

 private:
  std::unique_ptr<MemoryBudget> memory_;  // The members below count their memory here.
  std::unique_ptr<DagInput> file_;
  std::unique_ptr<Svdag> coarse_;
  std::unique_ptr<SceneBytes> bytes_;
};

}  // namespace voxdag
