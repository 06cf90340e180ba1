/// Files for other programs, and pages that show the DAG.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "dag.hpp"
#include "run_work.hpp"
#include "viewer/embedded/baked_page.hpp"
#include "viewer/site/export_site.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/exports/export_scene.hpp"
#include "voxdag/formats/exports/grids/export_slices.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

/// Writes the viewer's page with the DAG, as `voxdag export` does.
void export_page(const Dag& dag, const std::filesystem::path& path, bool colors,
                 const std::string& title) {
  PageView view{.settings = {}, .title = title, .poster = {}};
  if (!title.empty())
    view.settings = "{\"version\":1,\"title\":" +
                    py::cast<std::string>(py::module_::import("json").attr("dumps")(title)) + "}";
  const std::uint64_t bytes = run_work([&](Work work) {
    DagAttributesView attributes = dag.model().attributes();
    if (!colors) attributes.colors = {};
    const auto scene =
        make_scene_bytes(dag.view(), dag.model().metadata(), attributes, AttributeForm::kWire);
    const BakedPage page(view);
    return export_single_page(path, *scene, work, page.files());
  });
  if (bytes > kHandyPageBytes)
    warn(path.string() + ": has " + std::to_string(bytes >> 20) +
         " MiB, which browsers open slowly: coarsen() makes it smaller");
}

std::vector<std::filesystem::path> export_dag(const Dag& dag, const std::filesystem::path& path,
                                              const std::optional<Window>& window, bool colors,
                                              bool faces, const std::optional<std::string>& slices,
                                              const std::optional<std::string>& up,
                                              const std::optional<bool>& manifold, bool merge,
                                              bool smooth, bool texture, const std::string& title) {
  const std::string extension = lower_case(path.extension().string());
  if (!slices && extension == ".html") {
    if (window || faces || up || manifold || merge || smooth || texture)
      throw py::value_error("a page has no choices but colors and title");
    export_page(dag, path, colors, title);
    return {path};
  }
  if (!title.empty()) throw py::value_error("title is for pages, .html, only");
  ExportOptions options;
  std::vector<std::string> notes;
  options.notes = &notes;
  const bool is_manifold = manifold.value_or(extension == ".stl" && !merge && !smooth);
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
    throw py::value_error("the extension must be " + export_extensions() + ", or .html");
  if (faces && extension != ".ply") throw py::value_error("faces are a choice for .ply only");
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
  dag.def("export", &export_dag, py::arg("path"), py::kw_only(), py::arg("window") = py::none(),
          py::arg("colors") = true, py::arg("faces") = false, py::arg("slices") = py::none(),
          py::arg("up") = py::none(), py::arg("manifold") = py::none(), py::arg("merge") = false,
          py::arg("smooth") = false, py::arg("texture") = false, py::arg("title") = "",
          R"(Writes the voxels in the format that the extension of `path` names. Returns the files.

.html              a page that shows the DAG in any browser, also offline; title: of the page
.glb .obj .stl .3mf     outer faces
.ply               points; with faces=True outer faces
.vox .binvox .schem .voxel.json .vdb .nvdb .npy .raw .spc.npy .nrrd .mha .mhd .vti .nii   voxels

window: ((x0, y0, z0), (x1, y1, z1)), the first voxel and one past the last; default: the grid.
colors: also write colours, if the DAG and the format have some.
up: 'y' or 'z', the axis that points up in the file; default: the custom of the format (y for .glb,
z for .vox, .stl and .3mf) if the source's is known.
merge: write .glb and .obj with the fewest triangles; their corners can lie inside edges of others.
texture: write the colours of .glb and .obj as a texture.
manifold: let each edge have two triangles; default: for .stl.
smooth: write a manifold without steps: .glb, .obj, .stl, .3mf and .ply.
slices: 'x', 'y' or 'z': write a folder of PNG files, one for each layer along the axis.
docs/export.md describes the formats. Raises ValueError for a choice that the format does not have,
OSError if a file cannot be written.)");
}

}  // namespace voxdag::python
