#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/file_placement.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

using Path = std::filesystem::path;
using Options = VoxelSourceOptions;

struct SourceFormat {
  const char* ending;
  bool has_threshold;
  std::unique_ptr<VoxelSource> (*open)(const Path& path, const Options& options);
};

std::unique_ptr<VoxelSource> open_text(const Path& path, const Options&) {
  return open_xyz_points(path);
}

constexpr SourceFormat kSourceFormats[] = {
    {".npy", true,
     [](const Path& path, const Options& options) { return open_npy(path, options.threshold); }},
    {".xyz", false, open_text},
    {".txt", false, open_text},
    {".csv", false, open_text},
    {".asc", false, open_text},
    {".pts", false, open_text},
    {".xyzrgb", false, open_text},
    {".ply", false, [](const Path& path, const Options&) { return open_ply_points(path); }},
    {".las", false, [](const Path& path, const Options&) { return open_las_points(path); }},
    {".pcd", false, [](const Path& path, const Options&) { return open_pcd_points(path); }},
    {".binvox", false, [](const Path& path, const Options&) { return open_binvox(path); }},
    {".nrrd", true,
     [](const Path& path, const Options& options) { return open_nrrd(path, options.threshold); }},
    {".nhdr", true,
     [](const Path& path, const Options& options) { return open_nrrd(path, options.threshold); }},
    {".nii", true,
     [](const Path& path, const Options& options) { return open_nifti(path, options.threshold); }},
    {".nii.gz", true,
     [](const Path& path, const Options& options) { return open_nifti(path, options.threshold); }},
    {".vdb", true,
     [](const Path& path, const Options& options) { return open_vdb(path, options.threshold); }},
    {".vox", false, [](const Path& path, const Options&) { return open_vox(path); }},
};

std::unique_ptr<VoxelSource> open_by_name(const Path& path, const Options& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return open_png_slices(path, options.threshold);
  std::string name = path.string(), endings;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const SourceFormat& format : kSourceFormats) {
    if (name.ends_with(format.ending)) {
      if (options.threshold && !format.has_threshold)
        throw Error(path.string(), "", "has no values to compare with a threshold");
      return format.open(path, options);
    }
    endings += std::string(endings.empty() ? "" : ", ") + format.ending;
  }
  if (name.ends_with(".laz")) throw Error(path.string(), "", kCompressedLas);
  throw Error(path.string(), "", "is none of " + endings + ", or a folder of .png files");
}

}  // namespace

std::unique_ptr<VoxelSource> open_voxel_source(const Path& path, const Options& options) {
  std::unique_ptr<VoxelSource> source = open_by_name(path, options);
  return options.use_placement ? with_file_placement(path, std::move(source)) : std::move(source);
}

}  // namespace voxdag
