#pragma once
/// Opens the scene of a command: a DAG in either form, or an ESVO.
#include <filesystem>
#include <optional>
#include <variant>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A DAG in memory, in the plain form. Move-only; views stay valid when it is moved.
class DagInput {
 public:
  /// Reads the file; decodes it if it has the compact form. `memory`, which may be null, counts
  /// what it holds. Throws Error(path, place, reason), OverMemory and Cancelled.
  DagInput(const std::filesystem::path& path, Progress* progress, MemoryBudget* memory = nullptr);

  SvdagView view() const;
  /// Returns the attributes of the DAG's cells; empty if the file has none.
  DagAttributesView attributes() const;
  const VdagMetadata& metadata() const { return metadata_; }
  const Grid& grid() const { return metadata_.grid; }
  std::uint64_t file_bytes() const { return file_bytes_; }
  /// Replaces the colours by one for each material. Throws Error if the file has no material ids.
  void show_materials(const std::filesystem::path& path, Progress* progress);
  /// Returns whether the file has the compact form.
  bool is_compact() const { return std::holds_alternative<Decoded>(dag_); }

 private:
  /// A compact file, decoded to the plain form.
  struct Decoded {
    std::optional<CompactFile> file;  ///< Empty if the file has no attributes.
    Svdag dag;
    CellIndex index;           ///< The numbers of the cells with attributes.
    ExpandedChunks expanded;   ///< Attributes that the file has in the wire form.
    DagAttributesView stored;  ///< Points into the members above, also after they are moved.

    SvdagView view() const { return dag.view(); }
    const DagAttributesView& attributes() const { return stored; }
  };
  static Decoded decode(const std::filesystem::path& path, Progress* progress,
                        MemoryBudget* memory);

  std::variant<VdagFile, Decoded> dag_;
  std::optional<ValuePages> material_colors_;  ///< After show_materials().
  VdagMetadata metadata_;
  std::uint64_t file_bytes_ = 0;
  MemoryReservation memory_;
};

/// A scene of any kind in memory. Move-only; views stay valid when it is moved.
class SceneInput {
 public:
  /// Reads a DAG like DagInput, or an ESVO.
  SceneInput(const std::filesystem::path& path, Progress* progress);

  VoxelSet voxels() const;
  /// Returns the DAG with its attributes; empty for an ESVO and a file without attributes.
  ColoredDagView colored_dag() const;
  const SceneMetadata& metadata() const;
  const Grid& grid() const { return metadata().grid; }
  /// Does what DagInput::show_materials() does. An ESVO has no material ids.
  void show_materials(const std::filesystem::path& path, Progress* progress);

 private:
  std::variant<DagInput, EsvoFile> scene_;
};

}  // namespace voxdag
