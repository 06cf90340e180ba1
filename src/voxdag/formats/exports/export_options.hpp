#pragma once
/// The options of exports, and the rules that all exports follow.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/orientation.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Exports write the voxels of a DAG, or the finest ones of an ESVO, to the formats of other
/// programs. They need less than 100 MiB of memory, whatever the size of the output. A file
/// that is larger than the free space of its disk is refused before anything is written. Outputs
/// appear when complete and depend on the voxels alone. On failure the functions throw
/// Error(path, place, reason). `grid` places the voxels in the world; grid.levels must equal
/// voxels.levels(). If the format cannot hold the placement, the functions write it beside the
/// output, as PATH.json, unless the output is a pipe or device.
enum class FaceMesh : std::uint8_t {
  kFewest,      ///< The largest rectangles for .glb and .obj; corners can lie inside edges.
  kWatertight,  ///< Every edge belongs to an even number of triangles: no corner lies inside one.
  kManifold,    ///< Every edge belongs to two triangles, and those of a corner form one fan.
  kSmooth       ///< A manifold whose corners move by up to a third of a voxel along each axis.
};

struct ExportOptions {
  /// The voxels to export: a half-open box of voxel coordinates, inside the grid and not empty.
  /// Without it, all voxels.
  std::optional<Box3i> window;
  /// The colours, normals and materials of points, faces and lists of coordinates: those that the
  /// file of the voxels stores, or those of another file of the same mesh. Empty: none.
  LookView look;
  /// How the scene was turned before the export, so that another axis points up (export_scene.hpp).
  /// `look` belongs to the scene before the turn. PATH.json records the turn.
  struct Turn {
    Orientation orientation;
    Vec3d origin;      ///< Of the grid before.
    char up, from_up;  ///< 'y' or 'z'.
  };
  std::optional<Turn> turn;
  /// How faces are written to .glb, .obj, .stl and .3mf. STL files are watertight at least, 3MF
  /// files manifolds. PLY files know two kinds: smooth or not.
  FaceMesh faces = FaceMesh::kFewest;
  /// Writes colours to .glb and .obj as a texture with a pixel for each colour, for programs that
  /// show no colours of corners. OBJ files get PATH.mtl and PATH.png, with their extension
  /// replaced.
  bool texture = false;
  /// Leaves out the slices without voxels (export_slices()).
  bool skip_empty = false;
  /// The unit of the world's coordinates, for formats that store one: mm, cm, m, in, ft, or empty.
  std::string unit;
  /// If not null: receives the number of triangles of .glb, .obj, .stl and .3mf, or of faces of
  /// .ply.
  std::uint64_t* faces_written = nullptr;
  /// If not null: receives lines for the user about the output.
  std::vector<std::string>* notes = nullptr;
  /// The greatest size of a dense array, in bytes; larger ones are refused before anything is
  /// written.
  std::uint64_t most_dense_bytes = std::uint64_t{16} << 30;
  /// Counts the grids of export_vdb(), and the vertices that the triangles still to come share in
  /// manifolds: a small part of a surface. May be null.
  MemoryBudget* memory = nullptr;
  /// Called from time to time with the fraction of the work and the number of voxels that are done.
  /// It may throw (Cancelled) to stop the export. While voxels are counted, both arguments are 0.
  std::function<void(double fraction, std::uint64_t voxels)> progress;

  /// Returns a reader of `look` for the voxels that are exported.
  LookReader look_reader() const {
    return LookReader(look, turn ? turn->orientation : Orientation{});
  }
};

}  // namespace voxdag
