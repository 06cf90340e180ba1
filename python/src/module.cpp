/// The Python module voxdag._voxdag. voxdag/__init__.py is what users import.
#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

py::dict info_of(const Dag& dag) {
  const VdagMetadata& metadata = dag.model().metadata();
  const Grid& grid = dag.grid();
  py::dict info;
  info["resolution"] = grid.resolution();
  info["voxel_size"] = grid.voxel_size;
  info["origin"] = py::make_tuple(grid.origin.x, grid.origin.y, grid.origin.z);
  info["voxels"] = metadata.counts.voxels;
  info["nodes"] = metadata.counts.dag_nodes();
  info["bytes"] = dag.view().bytes();
  info["source"] = metadata.source.name;
  info["up"] = metadata.presentation.up ? std::string(1, *metadata.presentation.up) : "";
  info["unit"] = metadata.presentation.unit;
  const DagAttributesView attributes = dag.model().attributes();
  info["has_colors"] = attributes.has_colors();
  info["has_normals"] = attributes.has_normals();
  info["has_materials"] = attributes.has_materials();
  return info;
}

/// Raises OSError for errors of files, ValueError for other bad input, and MemoryError.
void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const OverMemory& error) {
    PyErr_SetString(PyExc_MemoryError, error.what());
  } catch (const Error& error) {
    PyErr_SetString(error.file().empty() ? PyExc_ValueError : PyExc_OSError, error.what());
  }
}

}  // namespace
}  // namespace voxdag::python

PYBIND11_MODULE(_voxdag, module) {
  using namespace voxdag;
  using namespace voxdag::python;
  py::register_exception_translator(translate);
  DagClass dag(module, "Dag",
               R"(A set of voxels with its place in the world, as a sparse voxel DAG.

A Dag does not change: edits return new ones, and threads may share it. Operators: a | b has the
voxels of either, a & b of both, a - b of a only, a ^ b of one only; a == b compares voxels and
place; len(a) counts the voxels.)");
  dag.def_property_readonly("info", &info_of,
                            "dict: resolution, voxel_size and origin (world units), voxels, nodes, "
                            "bytes, source, up ('x', 'y', 'z' or ''), unit ('mm', 'cm', 'm', 'in', "
                            "'ft' or '' if it is not known), has_colors, has_normals, "
                            "has_materials.")
      .def_property_readonly(
          "resolution", [](const Dag& d) { return d.grid().resolution(); },
          "Voxels per side of the grid.")
      .def_property_readonly(
          "voxel_size", [](const Dag& d) { return d.grid().voxel_size; },
          "Side of a voxel, in world units.")
      .def_property_readonly(
          "origin",
          [](const Dag& d) {
            const Vec3d o = d.grid().origin;
            return py::make_tuple(o.x, o.y, o.z);
          },
          "Lower corner of the grid, in world units.")
      .def("__len__", [](const Dag& d) { return d.model().metadata().counts.voxels; })
      .def(
          "save",
          [](const Dag& d, const std::filesystem::path& path, bool compact) {
            run_work([&](Work work) {
              check_vdag_name(path);
              d.model().save(path, compact, work);
              return 0;
            });
          },
          py::arg("path"), py::kw_only(), py::arg("compact") = false,
          R"(Writes a .vdag file to `path`, with the bytes that `voxdag build` would write.

compact: write the compact form, which takes about a quarter of the bytes. export() writes other
formats, and pages: their endings raise OSError here.)")
      .def_property_readonly("_nodes",
                             [](const py::object& self) {
                               const SvdagView view = self.cast<const Dag&>().view();
                               py::array_t<std::uint32_t> array(
                                   {view.node_words()}, {sizeof(std::uint32_t)}, view.nodes, self);
                               array.attr("setflags")(py::arg("write") = false);
                               return array;
                             })
      .def_property_readonly("_leaf_blocks", [](const py::object& self) {
        const SvdagView view = self.cast<const Dag&>().view();
        py::array_t<std::uint64_t> array({view.leaf_block_count}, {sizeof(std::uint64_t)},
                                         view.leaf_blocks, self);
        array.attr("setflags")(py::arg("write") = false);
        return array;
      });
  module.attr("__version__") = written_by().substr(std::string("voxdag ").size());
  add_makers(module);
  add_rays(dag);
  add_contacts(dag);
  add_queries(dag);
  add_edits(dag);
  add_materials(dag);
  add_channels(dag);
  add_exports(dag);
  add_pictures(dag);
  add_live_edits(module);
}
