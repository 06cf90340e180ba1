#pragma once
/// The voxels of a DAG, or the finest ones of an ESVO, in the formats of other programs.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"

namespace voxdag {

struct ExportOptions {
  /// Half-open box of voxel coordinates to export, inside the grid and not empty; all if absent.
  std::optional<Box3i> window;
  /// The most bytes that a dense array may have; larger ones are refused before anything is
  /// written.
  std::uint64_t most_dense_bytes = std::uint64_t{16} << 30;
  /// Called now and then with the number of voxels done; may throw (Cancelled) to stop.
  std::function<void(std::uint64_t voxels)> progress;
};

/// All functions below stream: memory stays below 100 MiB whatever the export's size. Outputs
/// appear when complete, depend on the voxels alone, and throw Error(path, place, reason) on
/// failure. `grid` places the voxels in the world; grid.levels equals voxels.levels(). Where the
/// format itself cannot hold the placement, it is written beside the output, as PATH.json (see
/// placement_json.hpp), unless the output is a pipe or device.

/// N×3 int32 voxel coordinates in Morton order, as .npy; with PATH.json.
void export_npy_coordinates(const std::filesystem::path& path, const VoxelSet& voxels,
                            const Grid& grid, const ExportOptions& options = {});

/// A dense uint8 array, 1 where a voxel is set, as .npy: element [a, b, c] is voxel window.lo + (a,
/// b, c), C order, so z changes fastest. With PATH.json.
void export_npy_dense(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

/// The dense bytes alone, 1 where a voxel is set, x changing fastest, then y, then z. With
/// PATH.json.
void export_raw(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options = {});

/// Voxel centres in world units, as binary little-endian PLY in Morton order. Coordinates are float
/// where that is exact to 1/16 voxel over the whole grid, double otherwise. Where an ESVO stores
/// them normals (nx, ny, nz) and colours (red, green, blue: 8 bits, sRGB) follow.
void export_ply_points(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                       const ExportOptions& options = {});

/// The voxels of the window as cubes in world units: each face whose neighbour is not among them,
/// as a quad that is counter-clockwise from outside. Corners are shared within a 4³ leaf block
/// only. Coordinates as above; at most 2^31 - 1 corners.
void export_ply_faces(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                      const ExportOptions& options = {});

enum class PlyContent { kPoints, kFaces };

/// Chooses by the extension: .npy (dense if there is a window, else coordinates), .ply, .raw.
void export_voxels(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                   PlyContent ply_content, const ExportOptions& options = {});

}  // namespace voxdag
