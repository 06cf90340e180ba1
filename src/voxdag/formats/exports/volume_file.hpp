#pragma once
/// Dense volumes for programs of images and simulations: NRRD, MetaImage, VTK ImageData and NIfTI.
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "voxdag/core/grid.hpp"

namespace voxdag {

class AtomicFile;
class GzipFile;

/// Returns whether VolumeFile writes the format that the ending of a name tells: .nrrd, .mha, .mhd,
/// .vti, .nii or .nii.gz.
bool is_volume_name(const std::string& name);

/// A volume with one number for each voxel of a window. x runs fastest, then y, then z. The header
/// places it: the coordinates are those of the grid, in its unit. All bytes are little-endian and
/// in one file.
class VolumeFile {
 public:
  enum class Values { kUint8, kFloat32 };

  /// `format` ends as is_volume_name() says. Throws Error if the file cannot be created or the
  /// format cannot hold the window (NIfTI: 32,767 voxels a side).
  VolumeFile(const std::filesystem::path& path, const std::string& format, const Grid& grid,
             const Box3i& window, Values values);
  ~VolumeFile();
  VolumeFile(const VolumeFile&) = delete;
  VolumeFile& operator=(const VolumeFile&) = delete;

  /// Appends values. Throws Error if the file cannot be written.
  void write(const void* data, std::size_t bytes);
  void commit();

 private:
  std::unique_ptr<AtomicFile> file_;
  std::unique_ptr<GzipFile> packed_;  ///< Instead of file_.
  std::string end_;                   ///< After the values.
};

}  // namespace voxdag
