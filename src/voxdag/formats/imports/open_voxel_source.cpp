#include <algorithm>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/imports/derived_source.hpp"
#include "voxdag/formats/imports/file_placement.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/volumes/slice_files.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/formats/input_file.hpp"

namespace voxdag {
namespace {

using Path = std::filesystem::path;
using Options = VoxelSourceOptions;

struct SourceFormat {
  const char* ending;
  bool has_threshold;
  std::unique_ptr<VoxelSource> (*open)(const Path& path, const Options& options);
};

using Source = std::unique_ptr<VoxelSource>;

template <auto kOpen>
Source with_labels(const Path& path, const Options& options) {
  return kOpen(path, options.labels);
}
/// For points, whose labels and channels are fields.
template <auto kOpen>
Source with_fields(const Path& path, const Options& options) {
  return kOpen(path, options.labels, options.channels);
}
template <PointText kKind>
Source open_text(const Path& path, const Options& options) {
  return open_xyz_points(path, options.labels, options.channels, kKind);
}
/// For volumes, whose values can be labels and a channel.
template <auto kOpen>
Source with_values(const Path& path, const Options& options) {
  return kOpen(path, options.threshold, options.labels, options.channels);
}

/// For packed splats, which are held in memory.
template <auto kOpen>
Source with_splats(const Path& path, const Options& options) {
  return kOpen(path, options.splats_are_points, options.work);
}
Source open_octomap_file(const Path& path, const Options& options) {
  return open_octomap(path, options.threshold);
}

constexpr SourceFormat kSourceFormats[] = {
    {".npy", true, with_values<open_npy>},
    {".xyz", false, open_text<PointText::kAny>},
    {".txt", false, open_text<PointText::kAny>},
    {".csv", false, open_text<PointText::kAny>},
    {".asc", false, open_text<PointText::kAny>},
    {".pts", false, open_text<PointText::kPts>},
    {".xyzrgb", false, open_text<PointText::kXyzrgb>},
    {".ply", false,
     [](const Path& path, const Options& options) {
       return open_ply_points(path, options.splats_are_points, options.labels, options.channels);
     }},
    {".splat", false,
     [](const Path& path, const Options& options) {
       return open_splat_file(path, options.splats_are_points);
     }},
    {".spz", false, with_splats<open_spz>},
    {".sog", false, with_splats<open_sog>},
    {".las", false, with_fields<open_las_points>},
    {".pcd", false, with_fields<open_pcd_points>},
    {".binvox", false, [](const Path& path, const Options&) { return open_binvox(path); }},
    {".nrrd", true, with_values<open_nrrd>},
    {".nhdr", true, with_values<open_nrrd>},
    {".nii", true, with_values<open_nifti>},
    {".nii.gz", true, with_values<open_nifti>},
    {".tif", true, with_values<open_tiff>},
    {".tiff", true, with_values<open_tiff>},
    {".dcm", true, with_values<open_dicom>},
    {".vdb", true,
     [](const Path& path, const Options& options) {
       return open_vdb(path, options.threshold, options.grid, options.labels, options.channels);
     }},
    {".vox", false, with_labels<open_vox>},
    {".schem", false, with_labels<open_schematic>},
    {".schematic", false, with_labels<open_schematic>},
    {".litematic", false, with_labels<open_schematic>},
    {".nbt", false, with_labels<open_schematic>},
    {".bt", true, open_octomap_file},
    {".ot", true, open_octomap_file},
};

/// Opens the files of a folder as slices.
std::unique_ptr<VoxelSource> open_slices(const Path& folder, const Options& options) {
  const auto has = [&](const std::string& ending) {
    return !names_of_slices(folder, [&](const std::string& name) {
              return lower_case(name).ends_with(ending);
            }).empty();
  };
  const bool has_png = has(".png"), has_tiff = has(".tif") || has(".tiff");
  if (has_png && has_tiff)
    throw Error(folder.string(), "", "the folder has .png and .tif files: which are the slices?");
  if (has_tiff) return with_values<open_tiff>(folder, options);
  // Files of DICOM may have any names.
  if (!has_png && has_dicom(folder)) return with_values<open_dicom>(folder, options);
  return open_png_slices(folder, options.threshold,
                         options.use_placement && has_numbered_slices(folder), options.labels,
                         options.channels);
}

/// Opens `path`, whose format the end of `name` tells.
std::unique_ptr<VoxelSource> open_by_name(const Path& path, std::string name,
                                          const Options& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return open_slices(path, options);
  std::string endings;
  name = lower_case(name);
  for (const SourceFormat& format : kSourceFormats) {
    if (name.ends_with(format.ending)) {
      if (options.threshold && !format.has_threshold)
        throw Error(path.string(), "", "has no values to compare with a threshold");
      if (!options.grid.empty() && format.ending != std::string_view(".vdb"))
        throw Error(path.string(), "", "has no grids with names: --grid is for .vdb files");
      return format.open(path, options);
    }
    endings += std::string(endings.empty() ? "" : ", ") + format.ending;
  }
  if (name.ends_with(".laz")) return with_fields<open_las_points>(path, options);  // Perhaps .las.
  if (name.ends_with(".e57"))
    throw Error(path.string(), "",
                "is an E57 file, which is not read: CloudCompare and PDAL save it as .ply");
  if (path != name && name.find('.') == name.npos)
    throw Error(path.string(), "", "has no ending that tells its format: --format does");
  throw Error(path.string(), "",
              "is none of " + endings + ", or a folder of .png, .tif or DICOM files");
}

/// The source of an unpacked file. Errors name the file that was given.
class UnpackedSource final : public DerivedSource {
 public:
  UnpackedSource(const Path& given, InputFile input, const std::string& name,
                 const Options& options)
      : DerivedSource(with_file_name(
            given.string(), [&] { return open_by_name(input.path(), name, options); },
            input.path().string())),
        given_(given.string()),
        input_(std::move(input)) {}

  void visit_all(const VisitBatch& visit) const override {
    with_file_name(
        given_, [&] { source_->visit_all(visit); }, input_.path().string());
  }

 private:
  std::string given_;
  InputFile input_;
};

std::unique_ptr<VoxelSource> open_input_file(const Path& path, const Options& options) {
  // The reader of NIfTI unpacks as it reads.
  if (options.format.empty() && path.string().ends_with(".nii.gz"))
    return open_by_name(path, path.string(), options);
  InputFile input(path, options.work);
  std::string name = input.name().string();
  if (!options.format.empty()) name = unpacked_name(name + "." + options.format).string();
  if (!input.is_in_memory()) return open_by_name(path, name, options);
  return std::make_unique<UnpackedSource>(path, std::move(input), name, options);
}

}  // namespace

bool is_voxel_source(const Path& name) {
  const std::string unpacked = lower_case(unpacked_name(name).string());
  return std::any_of(std::begin(kSourceFormats), std::end(kSourceFormats),
                     [&](const SourceFormat& format) { return unpacked.ends_with(format.ending); });
}

bool is_slice_folder(const Path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return false;
  const auto is_slice = [&](const std::string& name) {
    const std::string lower = lower_case(name);
    return lower.ends_with(".png") || lower.ends_with(".tif") || lower.ends_with(".tiff") ||
           is_dicom(path / name);
  };
  return !names_of_slices(path, is_slice).empty();
}

std::unique_ptr<VoxelSource> open_voxel_source(const Path& path, const Options& options) {
  std::unique_ptr<VoxelSource> source = open_input_file(path, options);
  if (options.labels && (source->has_splats() || !source->has_labels()))
    throw Error(path.string(), "",
                source->has_splats() ? "holds splats, which have no labels"
                                     : "has a format of which no labels are read");
  if (!options.channels.empty() && (source->has_splats() || source->channels().empty()))
    throw Error(path.string(), "",
                source->has_splats() ? "holds splats, which have no channels: --points reads their "
                                       "centres"
                                     : "has a format of which no channels are read");
  return options.use_placement ? with_file_placement(path, std::move(source)) : std::move(source);
}

}  // namespace voxdag
