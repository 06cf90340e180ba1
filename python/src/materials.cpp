/// The methods of Dag for materials and labels.
#include <pybind11/stl.h>

#include <map>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/attributes/material_voxels.hpp"
#include "voxdag/file/model/edited.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

const AttributesMetadata& materials_of(const Dag& dag) {
  const AttributesMetadata& attributes = dag.model().metadata().attributes;
  if (!attributes.materials) throw py::value_error("the DAG has no materials");
  return attributes;
}

py::list material_list(const Dag& dag) {
  const AttributesMetadata& attributes = materials_of(dag);
  const std::vector<MaterialVoxels> voxels = run_work(
      [&](Work work) { return material_voxels(dag.view(), dag.model().attributes(), work); });
  py::list list;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    py::dict row;
    row["id"] = i;
    row["name"] = (*attributes.materials)[i];
    row["label"] = attributes.labels.empty() ? py::object(py::none())
                                             : py::object(py::int_(attributes.labels[i]));
    row["voxels"] = voxels[i].voxels;
    const auto tuple_of = [](Vec3i v) { return py::make_tuple(v.x, v.y, v.z); };
    const Box3i& box = voxels[i].bounds;
    row["window"] = voxels[i].voxels == 0
                        ? py::object(py::none())
                        : py::object(py::make_tuple(tuple_of(box.lo), tuple_of(box.hi)));
    list.append(row);
  }
  return list;
}

py::array_t<std::int64_t> labels_of(const Dag& dag, const ArrayLike& given) {
  const AttributesMetadata& attributes = materials_of(dag);
  LookReader look(dag.look());
  std::vector<std::int64_t> labels;
  for (const Vec3i voxel : voxels_of(given, "voxels")) {
    const std::uint16_t id = look.read(voxel, dag.grid().levels).material;
    if (id == kMaxMaterials)
      labels.push_back(-1);
    else
      labels.push_back(attributes.labels.empty() ? id : attributes.labels[id]);
  }
  return array_of(labels);
}

DagPointer kept_materials(const Dag& dag, const std::optional<py::list>& keep,
                          const std::optional<py::list>& drop) {
  const AttributesMetadata& attributes = materials_of(dag);
  if (keep.has_value() == drop.has_value()) throw py::value_error("give one of keep and drop");
  std::vector<bool> keeps(attributes.materials->size(), drop.has_value());
  std::string names;
  for (const py::handle wanted : keep ? *keep : *drop) {
    const std::string name = py::str(wanted);
    const std::optional<std::size_t> id = find_material(attributes, name);
    if (!id) throw py::value_error("the DAG has no material " + name);
    keeps[*id] = keep.has_value();
    names += (names.empty() ? "" : ", ") + name;
  }
  return run_work([&](Work work) {
    Svdag kept = keep_materials(dag.view(), dag.model().attributes(), keeps, work);
    const PlacedModel placed{dag.model()};
    return std::make_shared<Dag>(edited({&placed, 1}, std::move(kept), dag.grid(),
                                        (keep ? "materials " : "without materials ") + names, {},
                                        work));
  });
}

}  // namespace

void add_materials(DagClass& dag) {
  dag.def("materials", &material_list,
          R"(Lists the materials, or the labels of an import. Returns a list of dicts.

id, name: of the material. label: the number that it has in the imported file, or None.
voxels: how many have it. window: ((x0, y0, z0), (x1, y1, z1)), the box that holds them, or None.
Raises ValueError if the DAG has no materials.)")
      .def("labels", &labels_of, py::arg("voxels"),
           R"(Returns the labels of voxels, (N,) int64; without labels, the ids of their materials.

voxels: (N, 3) whole numbers; -1 where none is. Raises ValueError if the DAG has no materials.)")
      .def("keep_materials", &kept_materials, py::arg("keep") = py::none(), py::kw_only(),
           py::arg("drop") = py::none(), R"(Returns the voxels of some materials.

keep, drop: a list of names and labels (without labels, ids): keep these, or all others.)");
}

}  // namespace voxdag::python
