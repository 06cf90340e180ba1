/// Files for other programs.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

std::vector<std::filesystem::path> export_dag(const Dag& dag, const std::filesystem::path& path,
                                              const std::optional<Window>& window, bool colors,
                                              bool faces,
                                              const std::optional<std::string>& slices) {
  ExportOptions options;
  if (window) options.window = window_of(dag, window);
  if (colors) options.look = dag.look();
  const int axis = slices ? axis_of(*slices) : 0;
  if (!slices && !can_export_to(path))
    throw py::value_error("the extension must be " + export_extensions());
  if (faces && path.extension() != ".ply")
    throw py::value_error("faces are a choice for .ply only");
  return run_work([&](Work work) -> std::vector<std::filesystem::path> {
    options.progress = [&](double, std::uint64_t) { work.poll(); };
    const VoxelSet voxels(dag.view());
    if (!slices) return export_voxels(path, voxels, dag.grid(), {faces}, options);
    export_slices(path, axis, voxels, dag.grid(), options);
    return {path};
  });
}

}  // namespace

void add_exports(DagClass& dag) {
  dag.def("export", &export_dag, py::arg("path"), py::kw_only(), py::arg("window") = py::none(),
          py::arg("colors") = true, py::arg("faces") = false, py::arg("slices") = py::none(),
          "Write the voxels for other programs: outer faces as .glb, .obj, .stl; voxels as .vox, "
          ".binvox, .schem, .voxel.json, .npy, .raw, .spc.npy, .vdb, .nvdb; points as .ply, with "
          "faces=True outer faces. slices='z' writes a folder of PNG files, one for each layer. "
          "docs/export.md has the formats. Returns the files.");
}

}  // namespace voxdag::python
