#pragma once
/// A DAG that changes while others read it: edits that cost what they touch, with undo.
///
/// Source of the idea: V. Careil, M. Billeter and E. Eisemann, "Interactively Modifying Compressed
/// Sparse Voxel Representations", Computer Graphics Forum 39(2), 2020 (HashDAG): nodes are
/// hash-consed, and an edit copies the paths to the cells that it changes. Here, nodes of an edit
/// lie behind those of the DAG as it was read (edit_nodes.hpp), and values of voxels in octrees
/// that replace stored values (stored/attributes/value_overlay.hpp). Each edit makes a new version:
/// a few roots. Undo goes back to an older version, and readers keep theirs.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/edit/edit_values.hpp"
#include "voxdag/edit/filter_ball.hpp"
#include "voxdag/edit/shapes.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {

/// Values that an edit gives to voxels, as far as the DAG has such values. For a value that is not
/// set, a voxel that an edit adds takes that of the voxel that was nearest to the shape's middle.
struct EditPaint {
  std::optional<Value8> color{};            ///< sRGB encoded.
  std::optional<std::uint32_t> material{};  ///< Below the number of the DAG's materials.
};

struct EditOptions {
  /// The number of edits that undo() can take back; 0: all.
  std::size_t history = 0;
  /// Notes what edits write, for take_changes(). Needs memory until it is taken.
  bool tracks_changes = false;
  /// Begins without voxels. The base has the kinds of values then (file/model/seeded.hpp).
  bool starts_empty = false;
};

/// How a stamp changes voxels.
enum class StampMode {
  kAdd,      ///< Adds its voxels; those that exist keep their values.
  kRemove,   ///< Removes its voxels.
  kReplace,  ///< Voxels in its box become exactly its own.
};

/// One version of an edited DAG. It stays as it is while edits go on, on any thread. Copies share.
class EditSnapshot {
 public:
  /// Returns the voxels. Only functions that walk from the root may take the view
  /// (SvdagView::root).
  const SvdagView& view() const { return version_->view; }
  /// Returns the voxels with their values; without values if the DAG has none.
  const ColoredDagView& values() const { return version_->values; }
  /// Returns the minimal DAG, in canonical order, of the voxels: the bytes of a file depend on the
  /// voxels alone. Throws OverMemory and Cancelled.
  Svdag svdag(Work work = {}) const;
  /// Returns the attributes of the cells of `dag`, which svdag() returned. Values that no edit
  /// changed are stored exactly as they were, but for `bounds`. Cells with changed voxels get the
  /// mean of their children (algebra/attributes/derive_attributes.hpp). Empty if the base has none.
  /// Throws OverMemory and Cancelled.
  DagAttributes attributes(const SvdagView& dag, const CoarsenBounds& bounds = {},
                           Work work = {}) const;

 private:
  friend class EditableDag;
  struct Version {
    std::shared_ptr<const EditNodes> nodes;
    std::shared_ptr<const EditValues> of_values;
    std::uint32_t root = EditNodes::kNone;
    std::uint32_t colors = kStoredValue, normals = kStoredValue, materials = kStoredValue;
    SvdagView view;
    std::uint64_t words_end = 0;  ///< The words of `view` lie before.
    ColoredDagView values;        ///< Of the base, with overlays.
  };
  explicit EditSnapshot(std::shared_ptr<const Version> version) : version_(std::move(version)) {}

  std::shared_ptr<const Version> version_;
};

/// The DAG and its history. Not thread-safe; snapshots are. A function that throws changes nothing.
/// All edits throw Error if the DAG outgrows 32-bit pointers or a value is out of range, OverMemory
/// and Cancelled.
class EditableDag {
 public:
  /// Copies a valid DAG without attributes. Takes time and memory in O(nodes). `work` counts memory
  /// as long as this object and its snapshots live.
  explicit EditableDag(const SvdagView& base, EditOptions options = {}, Work work = {})
      : EditableDag(ColoredDagView{base, {}}, options, work) {}
  /// Copies a valid DAG, but not its attributes, which must outlive this object and its snapshots.
  explicit EditableDag(const ColoredDagView& base, EditOptions options = {}, Work work = {});

  int levels() const { return nodes_->levels(); }

  void add(const EditShape& shape, const EditPaint& paint = {});
  void remove(const EditShape& shape);
  /// Gives values to the voxels of a shape. Throws Error if the DAG has no such values.
  void paint(const EditShape& shape, const EditPaint& paint);
  /// Adds the voxels of a shape and gives values to all of them, old and new, as one edit. Throws
  /// Error if the DAG has no such values.
  void replace(const EditShape& shape, const EditPaint& paint);
  /// Joins the voxels of a DAG of the same number of levels. `look` has their values; empty:
  /// `paint` and the nearest voxels. `box` is the stamp's box for kReplace, in voxels: its lower
  /// corner belongs to it, its upper one does not.
  void stamp(const SvdagView& voxels, StampMode mode, const LookView& look = {},
             const EditPaint& paint = {}, const Box3i& box = {});
  /// Copies the voxels of a box, with their values, to where its lower corner is `to`. What would
  /// lie outside the grid is left out. With `moves`, the box itself becomes empty first.
  void copy(const Box3i& box, Vec3i to, bool moves);
  /// Changes the voxels of a ball of at most kMaxFilterRadius voxels' radius (filter_ball.hpp).
  void filter(const BallShape& ball, BallFilter filter);

  /// Goes back one edit, or forward again. Returns false if there is none.
  bool undo();
  bool redo();
  std::size_t undo_count() const { return now_; }
  std::size_t redo_count() const { return versions_.size() - 1 - now_; }

  EditSnapshot snapshot() const { return EditSnapshot(versions_[now_]); }
  const EditNodes& nodes() const { return *nodes_; }
  const EditValues& values() const { return *values_; }

  /// Frees the memory of nodes and values that no version and no snapshot uses, for later edits.
  /// Edits call it when versions were dropped and memory has doubled since, or when it runs out.
  void collect();
  /// Returns what was written since the last call, for copies of the arrays elsewhere. Nothing
  /// without EditOptions::tracks_changes.
  EditChanges take_changes() { return nodes_->take_changes(); }
  std::vector<EditRun> take_value_changes() { return values_->take_changes(); }

 private:
  using Version = EditSnapshot::Version;
  /// Makes a version from the current one.
  using Change = std::function<void(Version&)>;

  void apply(const Change& change);
  void push(Version version);
  bool has_values() const { return !attributes_.is_empty(); }
  void check(const EditPaint& paint) const;
  void add_shape(Version& version, const EditShape& shape, const EditPaint& paint);
  void paint_shape(Version& version, const EditShape& shape, const EditPaint& paint);
  std::uint32_t join_stamp(std::uint32_t root, const SvdagView& voxels, bool adds);
  /// Gives values to the voxels that `version` has and the root `before` has not. The voxels that
  /// were nearest in the current version have what `paint` lacks: nearest to the middle of `shape`,
  /// or if it is null, to each new voxel.
  void paint_new(Version& version, std::uint32_t before, const EditPaint& paint,
                 const EditShape* shape);
  /// Gives the values that the reader has for cell source(cell) to each cell that `version` has and
  /// the root `before` has not.
  template <class Place>
  void paint_stamp(Version& version, std::uint32_t before, LookReader& reader, const Place& source);
  std::uint64_t used_bytes() const;

  Work work_;
  EditOptions options_;
  DagAttributesView attributes_;
  std::shared_ptr<EditNodes> nodes_;
  std::shared_ptr<EditValues> values_;
  std::vector<std::shared_ptr<const Version>> versions_;
  std::size_t now_ = 0;
  std::vector<std::weak_ptr<const Version>> alive_;
  std::uint64_t collect_at_;
  std::size_t drops_ = 0;  ///< Versions that were dropped since collect().
};

}  // namespace voxdag
