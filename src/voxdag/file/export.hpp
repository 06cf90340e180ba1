#pragma once
/// Exports the voxels of a DAG, or the finest ones of an ESVO, to the formats of other programs.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/look.hpp"
#include "voxdag/layout/voxel_set.hpp"

namespace voxdag {

struct ExportOptions {
  /// The voxels to export: a half-open box of voxel coordinates, inside the grid and not empty.
  /// Without it, all voxels.
  std::optional<Box3i> window;
  /// The colours, normals and materials of points, faces and lists of coordinates: those that the
  /// file of the voxels stores, or those of another file of the same mesh. Empty: none.
  LookView look;
  /// The greatest size of a dense array, in bytes; larger ones are refused before anything is
  /// written.
  std::uint64_t most_dense_bytes = std::uint64_t{16} << 30;
  /// Called from time to time with the fraction of the work and the number of voxels that are done.
  /// It may throw (Cancelled) to stop the export. While voxels are counted, both arguments are 0.
  std::function<void(double fraction, std::uint64_t voxels)> progress;
};

/// All functions below need less than 100 MiB of memory, whatever the size of the output. A file
/// that is larger than the free space of its disk is refused before anything is written. Outputs
/// appear when complete and depend on the voxels alone. On failure the functions throw
/// Error(path, place, reason). `grid` places the voxels in the world; grid.levels must equal
/// voxels.levels(). If the format cannot hold the placement, the functions write it beside the
/// output, as PATH.json, unless the output is a pipe or device.

/// Writes voxel coordinates in Morton order as .npy; with PATH.json. The array is N×3 int32. With a
/// look it is a structured array of shape (N,): voxel (int32 × 3), normal (float32 × 3), color
/// (uint8 × 3) and material (uint16), as far as the look has them.
void export_npy_coordinates(const std::filesystem::path& path, const VoxelSet& voxels,
                            const Grid& grid, const ExportOptions& options = {});

/// Writes a dense uint8 array as .npy: 1 for voxels that are set, else 0. Element [a, b, c] is
/// voxel window.lo + (a, b, c), in C order, so z changes fastest. With PATH.json.
void export_npy_dense(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

/// Writes a dense array without a header, one byte per voxel: 1 for voxels that are set, else 0. x
/// changes fastest, then y, then z. With PATH.json.
void export_raw(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

/// Writes voxel centres in world units, in Morton order, as binary little-endian PLY. Coordinates
/// are float if that is exact to 1/16 voxel over the whole grid, else double. Normals (nx, ny, nz),
/// colours (red, green, blue: 8 bits, sRGB) and the number of the material (material: 16 bits)
/// follow if the look has them.
void export_ply_points(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                       const ExportOptions& options = {});

/// Writes the voxels of the window as cubes in world units, as PLY: a quad, counter-clockwise from
/// outside, for each face whose neighbour is not a voxel of the window. Quads share corners within
/// a leaf block of 4³. With a look, they share corners only within a voxel, and each corner has the
/// attributes of that voxel. Coordinates are as in export_ply_points(); at most 2^31 - 1 corners.
void export_ply_faces(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

enum class PlyContent { kPoints, kFaces };

/// Returns whether export_voxels() knows the extension of `path`.
bool can_export_to(const std::filesystem::path& path);

/// Chooses the format by the extension: .npy (dense if there is a window, else coordinates), .ply,
/// .raw.
void export_voxels(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   PlyContent ply_content, const ExportOptions& options = {});

}  // namespace voxdag
