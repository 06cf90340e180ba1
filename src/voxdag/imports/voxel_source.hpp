#pragma once
/// Files of voxels and of points, read as a stream.
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// A file that can be read several times. Errors name the file and the place.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;

  /// Returns whether the file has points in world units; otherwise it has voxels of a grid.
  virtual bool has_points() const = 0;
  /// Returns the grid of the voxels, if the file has one.
  virtual std::optional<Grid> grid() const { return std::nullopt; }
  /// Calls visit() for each point, or for each voxel as whole numbers. Throws Error, and what
  /// `visit` throws.
  virtual void visit_all(const std::function<void(Vec3d)>& visit) const = 0;
};

/// Opens an array of NumPy: N × 3 int32 are voxels, N × 3 float32 or float64 are points.
std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path);
/// Opens a text of points: three numbers in each line, and perhaps more that are ignored. Blanks,
/// tabs, commas or semicolons separate them; # begins a comment. At most 1 MiB per line.
std::unique_ptr<VoxelSource> open_xyz_points(const std::filesystem::path& path);
/// Opens a grid of voxels, run-length encoded (Patrick Min, "binvox").
std::unique_ptr<VoxelSource> open_binvox(const std::filesystem::path& path);

/// Opens a file by the end of its name: .npy, .xyz, .txt, .csv or .binvox. Throws Error for others.
std::unique_ptr<VoxelSource> open_voxel_source(const std::filesystem::path& path);

}  // namespace voxdag
