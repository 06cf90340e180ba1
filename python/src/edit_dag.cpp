/// DAGs from DAGs: set operations, moves, dilation. Results have no colours.
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <array>

#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/model/aligned_models.hpp"
#include "voxdag/model/edited.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

DagPointer edited_dag(const Dag& source, Svdag dag, const std::string& edit) {
  return std::make_shared<Dag>(edited(source.model(), std::move(dag), source.grid(), edit));
}

DagPointer combined(const Dag& a, const Dag& b, SetOperation operation, const char* name) {
  return run_work([&](Progress& progress) {
    const AlignedModels aligned(a.model(), b.model(), nullptr, &progress);
    return std::make_shared<Dag>(
        edited(a.model(), aligned.result(operation), aligned.grid_of(operation),
               std::string(name) + " " + b.model().metadata().source.name));
  });
}

Neighbours neighbours_of(int count) {
  if (count == 6) return Neighbours::k6;
  if (count == 26) return Neighbours::k26;
  throw py::value_error("neighbours must be 6 or 26");
}

DagPointer grown(const Dag& dag, int steps, int neighbours, bool is_dilation) {
  if (steps < 1) throw py::value_error("steps must be at least 1");
  const Neighbours kind = neighbours_of(neighbours);
  return run_work([&](Progress& progress) {
    return edited_dag(dag,
                      is_dilation ? dilate(dag.view(), steps, kind, nullptr, &progress)
                                  : erode(dag.view(), steps, kind, nullptr, &progress),
                      (is_dilation ? "dilated by " : "eroded by ") + std::to_string(steps));
  });
}

}  // namespace

void add_edits(DagClass& dag) {
  const auto add = [&dag](const char* name, SetOperation operation, const char* text,
                          const char* help) {
    dag.def(
        name, [=](const Dag& a, const Dag& b) { return combined(a, b, operation, text); },
        py::is_operator(), help);
  };
  add("__or__", SetOperation::kUnion, "union with", "Voxels of either DAG.");
  add("__and__", SetOperation::kIntersection, "intersection with", "Voxels of both DAGs.");
  add("__sub__", SetOperation::kDifference, "minus", "Voxels of the first DAG only.");
  add("__xor__", SetOperation::kSymmetric, "symmetric difference with", "Voxels of one DAG only.");
  dag.def(
         "__eq__",
         [](const Dag& a, const Dag& b) {
           const SvdagView x = a.view(), y = b.view();
           return a.grid() == b.grid() && x.node_words() == y.node_words() &&
                  x.leaf_block_count == y.leaf_block_count &&
                  std::equal(x.nodes, x.nodes + x.node_words(), y.nodes) &&
                  std::equal(x.leaf_blocks, x.leaf_blocks + x.leaf_block_count, y.leaf_blocks);
         },
         py::is_operator(), "Whether both have the same voxels at the same place.")
      .def(
          "dilate", [](const Dag& d, int steps, int n) { return grown(d, steps, n, true); },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          "Add the voxels that are `steps` steps from voxels, to 6 or 26 neighbours.")
      .def(
          "erode", [](const Dag& d, int steps, int n) { return grown(d, steps, n, false); },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          "Remove the voxels that are `steps` steps from empty places.")
      .def(
          "fill_cavities",
          [](const Dag& d) {
            return run_work([&](Progress& progress) {
              return edited_dag(d, fill_cavities(d.view(), nullptr, &progress), "filled");
            });
          },
          "Fill the empty places that no way over faces connects with the sides of the grid.");
}

}  // namespace voxdag::python
