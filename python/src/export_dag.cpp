/// Files for other programs.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/formats/exports/export_scene.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

std::vector<std::filesystem::path> export_dag(const Dag& dag, const std::filesystem::path& path,
                                              const std::optional<Window>& window, bool colors,
                                              bool faces, const std::optional<std::string>& slices,
                                              const std::optional<std::string>& up,
                                              const std::optional<bool>& manifold, bool merge,
                                              bool smooth, bool texture) {
  ExportOptions options;
  std::vector<std::string> notes;
  options.notes = &notes;
  const bool is_manifold = manifold.value_or(path.extension() == ".stl" && !merge && !smooth);
  options.faces = smooth        ? FaceMesh::kSmooth
                  : is_manifold ? FaceMesh::kManifold
                  : merge       ? FaceMesh::kFewest
                                : FaceMesh::kWatertight;
  options.texture = texture;
  if (up && (slices || (*up != "y" && *up != "z")))
    throw py::value_error("up must be 'y' or 'z', and is not for slices");
  if (is_manifold + merge + smooth > 1)
    throw py::value_error("choose one of manifold, smooth and merge");
  if (window) options.window = window_of(dag, window);
  if (colors) options.look = dag.look();
  const int axis = slices ? axis_of(*slices) : 0;
  if (!slices && !can_export_to(path))
    throw py::value_error("the extension must be " + export_extensions());
  if (faces && path.extension() != ".ply")
    throw py::value_error("faces are a choice for .ply only");
  ExportContent content;
  content.ply_faces = faces || smooth;
  if (up) content.up = (*up)[0];
  std::vector<std::filesystem::path> files =
      run_work([&](Work work) -> std::vector<std::filesystem::path> {
        options.progress = [&](double, std::uint64_t) { work.poll(); };
        const VoxelSet voxels(dag.view());
        if (!slices)
          return export_scene(path, voxels, dag.model().metadata(), content, options, work);
        export_slices(path, axis, voxels, dag.grid(), options);
        return {path};
      });
  for (const std::string& note : notes) warn(note);
  return files;
}

}  // namespace

void add_exports(DagClass& dag) {
  dag.def(
      "export", &export_dag, py::arg("path"), py::kw_only(), py::arg("window") = py::none(),
      py::arg("colors") = true, py::arg("faces") = false, py::arg("slices") = py::none(),
      py::arg("up") = py::none(), py::arg("manifold") = py::none(), py::arg("merge") = false,
      py::arg("smooth") = false, py::arg("texture") = false,
      "Write the voxels for other programs: outer faces as .glb, .obj, .stl, .3mf; voxels as .vox, "
      ".binvox, .schem, .voxel.json, .npy, .raw, .spc.npy, .vdb, .nvdb; points as .ply, with "
      "faces=True outer faces. up: 'y' or 'z', the axis that points up in the file; default: the "
      "custom of the format (y for .glb, z for .vox, .stl and .3mf) if the source's is known. "
      ".glb and .obj: merge=True writes the fewest triangles, whose corners can lie inside edges "
      "of others; texture=True writes colours as a texture. manifold=True (also .stl): each edge "
      "has two triangles. smooth=True (also .stl, .3mf, .ply): a manifold without steps. "
      "slices='z' writes a folder of PNG files, one for each layer. "
      "docs/export.md has the formats. Returns the files.");
}

}  // namespace voxdag::python
