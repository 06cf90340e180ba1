#include "voxdag/formats/exports/export_voxels.hpp"

#include <string>
#include <string_view>

#include "voxdag/algebra/crop.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/exports/export_arrays.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/export_ply.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/grids/export_binvox.hpp"
#include "voxdag/formats/exports/grids/export_playcanvas.hpp"
#include "voxdag/formats/exports/grids/export_schem.hpp"
#include "voxdag/formats/exports/grids/export_spc.hpp"
#include "voxdag/formats/exports/grids/export_vdb.hpp"
#include "voxdag/formats/exports/grids/export_vox.hpp"

namespace voxdag {
namespace {

/// The arguments of export_voxels().
struct Request {
  const std::filesystem::path& path;
  const VoxelSet& voxels;
  const Grid& grid;
  const ExportContent& content;
  const ExportOptions& options;
};

using Files = std::vector<std::filesystem::path>;
using Exporter = void (*)(const std::filesystem::path&, const VoxelSet&, const Grid&,
                          const ExportOptions&);

template <Exporter kExport>
Files one_file(const Request& r) {
  kExport(r.path, r.voxels, r.grid, r.options);
  return {r.path};
}

Files npy(const Request& r) {
  return r.options.window ? one_file<export_npy_dense>(r) : one_file<export_npy_coordinates>(r);
}

Files volume(const Request& r) {
  const std::string& format = r.content.format;
  export_volume(r.path, format.empty() ? r.path.filename().string() : "." + format, r.voxels,
                r.grid, r.options);
  return {r.path};
}

Files ply(const Request& r) {
  return r.content.ply_faces ? one_file<export_ply_faces>(r) : one_file<export_ply_points>(r);
}

Files vox(const Request& r) { return export_vox(r.path, r.voxels, r.grid, r.options); }

/// Writes a format that is for DAGs only, and that has no windows: crops the DAG.
template <void (*kExport)(const std::filesystem::path&, const SvdagView&, const Grid&,
                          const ExportOptions&)>
Files dag_file(const Request& r) {
  const SvdagView* const dag = r.voxels.dag();
  if (dag == nullptr)
    throw Error(r.path.string(), "",
                "this format is for DAGs, but the scene is an ESVO: build a .vdag of its mesh");
  const Box3i window = export_window(r.path, r.voxels, r.options);
  if (r.options.window)
    kExport(r.path, crop(*dag, window, r.options.memory).view(), r.grid, r.options);
  else
    kExport(r.path, *dag, r.grid, r.options);
  return {r.path};
}

struct ExportFormat {
  std::string_view ending;
  Files (*write)(const Request&);
  bool has_colors;
  char up = 0;                 ///< The axis that points up by custom; 0: none.
  bool has_placement = false;  ///< `write` writes PATH.json, or removes that of an earlier export.

  bool has_channels(bool has_window) const {
    return (write == npy && !has_window) || write == ply || write == one_file<export_vdb>;
  }
};

/// ".spc.npy" comes before ".npy": the first ending that matches counts.
constexpr ExportFormat kExportFormats[] = {{".spc.npy", dag_file<export_spc>, false, 0, true},
                                           {".npy", npy, true, 0, true},
                                           {".raw", one_file<export_raw>, false, 0, true},
                                           {".ply", ply, true},
                                           {".glb", one_file<export_glb>, true, 'y'},
                                           {".obj", one_file<export_obj>, true},
                                           {".stl", one_file<export_stl>, false, 'z', true},
                                           {".3mf", one_file<export_3mf>, true, 'z'},
                                           {".vox", vox, true, 'z', true},
                                           {".binvox", one_file<export_binvox>, false},
                                           {".schem", one_file<export_schem>, true, 'y', true},
                                           {".voxel.json", dag_file<export_playcanvas>, false},
                                           {".nrrd", volume, false},
                                           {".mha", volume, false},
                                           {".mhd", volume, false},
                                           {".vti", volume, false},
                                           {".nii", volume, false},
                                           {".nii.gz", volume, false},
                                           {".vdb", one_file<export_vdb>, true},
                                           {".nvdb", one_file<export_vdb>, true}};

/// Returns the format of a file, or null.
const ExportFormat* format_of(const std::filesystem::path& path, const std::string& format = {}) {
  const std::string name = lower_case(format.empty() ? path.filename().string() : "a." + format);
  for (const ExportFormat& known : kExportFormats)
    if (name.size() > known.ending.size() && name.ends_with(known.ending)) return &known;
  return nullptr;
}

}  // namespace

bool can_export_to(const std::filesystem::path& path) { return format_of(path) != nullptr; }

void check_vdag_name(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".esvo")
    throw Error(path.string(), "",
                "the file would be a DAG, and `voxdag build` makes .esvo files of meshes: end the "
                "name in .vdag (other formats: voxdag export)");
  const ExportFormat* const format = format_of(path);
  if (extension == ".html" || format != nullptr)
    throw Error(path.string(), "",
                "the file would be a DAG: end the name in .vdag, and write a " +
                    (format != nullptr ? std::string(format->ending) : extension) +
                    " file with voxdag export");
}

std::string export_extensions() {
  std::string text;
  for (const ExportFormat& format : kExportFormats) {
    if (!text.empty()) text += &format == std::end(kExportFormats) - 1 ? " or " : ", ";
    text += format.ending;
  }
  return text;
}

std::optional<char> custom_up(const std::filesystem::path& path, const ExportContent& content) {
  const ExportFormat* const format = format_of(path, content.format);
  return format == nullptr || format->up == 0 ? std::nullopt : std::optional(format->up);
}

bool export_has_colors(const std::filesystem::path& path, bool has_window) {
  const ExportFormat* const format = format_of(path);
  return format != nullptr && format->has_colors && !(format->write == npy && has_window);
}

std::vector<std::filesystem::path> export_voxels(const std::filesystem::path& path,
                                                 const VoxelSet& voxels, const Grid& grid,
                                                 const ExportContent& content,
                                                 const ExportOptions& options) {
  const ExportFormat* const format = format_of(path, content.format);
  if (format == nullptr)
    throw Error(path.string(), "",
                "cannot export to '" +
                    (content.format.empty() ? path.extension().string() : content.format) +
                    "': the extension must be " + export_extensions());
  Files files = format->write({path, voxels, grid, content, options});
  if (!format->has_placement) remove_placement(path);
  if (options.notes != nullptr && options.look.dag.attributes.has_channels() &&
      !format->has_channels(options.window.has_value()))
    options.notes->push_back(
        "the channels are left out: .ply, .npy without a window, .vdb and .nvdb have them");
  return files;
}

}  // namespace voxdag
