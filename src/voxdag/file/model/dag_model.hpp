#pragma once
/// A DAG with its attributes and metadata.
#include <filesystem>
#include <optional>
#include <variant>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {

/// The content of a .vdag file in memory: the DAG in the plain form, the attributes of its cells,
/// and the metadata. Move-only; views stay valid when it is moved.
class DagModel {
 public:
  /// Reads the file; decodes it if it has the compact form. `work` counts what it holds. Throws
  /// Error(path, place, reason), OverMemory and Cancelled.
  explicit DagModel(const std::filesystem::path& path, Work work = {})
      : DagModel(VdagContainer(path, work.memory), work) {}
  /// Reads an open file in the same way. `work` does not count the bytes of `file` again.
  explicit DagModel(VdagContainer file, Work work = {});

  /// Holds a DAG and the attributes of its cells, which may be empty. metadata.grid.levels must
  /// equal dag.levels. Sets metadata.counts and metadata.program. `work` counts them. Throws
  /// OverMemory.
  DagModel(Svdag dag, DagAttributes attributes, VdagMetadata metadata, Work work = {});

  /// Writes the file; `compact` chooses the compact form. Throws Error, OverMemory and Cancelled.
  void save(const std::filesystem::path& path, bool compact, Work work = {}) const;

  SvdagView view() const;
  /// Returns the attributes of the DAG's cells; empty if the file has none.
  DagAttributesView attributes() const;
  const VdagMetadata& metadata() const { return metadata_; }
  const Grid& grid() const { return metadata_.grid; }
  void set_presentation(const Presentation& presentation) { metadata_.presentation = presentation; }
  std::uint64_t file_bytes() const { return file_bytes_; }
  /// Replaces the colours by one for each material. Throws Error if the file has no material ids.
  void show_materials(const std::filesystem::path& path, Work work);
  /// Replaces the colours by those of a channel's values (channel_colors.hpp). Without `range`,
  /// they reach from the least to the greatest value. Returns the range. Throws Error if the file
  /// has no such channel.
  ChannelRange show_channel(const std::filesystem::path& path, const std::string& name,
                            const std::optional<ChannelRange>& range, Work work);
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
  /// A DAG that was made in memory.
  struct Made {
    Svdag dag;
    DagAttributes stored;

    SvdagView view() const { return dag.view(); }
    DagAttributesView attributes() const { return stored.view(); }
  };
  static Decoded decode(CompactFile file, const std::string& path, Work work);

  std::variant<VdagFile, Decoded, Made> dag_;
  std::optional<ValuePages> shown_colors_;  ///< After show_materials() and show_channel().
  VdagMetadata metadata_;
  std::uint64_t file_bytes_ = 0;
  MemoryReservation memory_;
};

}  // namespace voxdag
