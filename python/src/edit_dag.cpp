/// DAGs from DAGs: set operations, moves, dilation, components. Results keep colours, normals and
/// materials; coarser DAGs keep colours only, and warn of what they drop.
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/model/aligned_models.hpp"
#include "voxdag/file/model/edited.hpp"
#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

/// The result of an edit, and whether it dropped attributes of its source.
struct Edited {
  DagPointer dag;
  bool drops = false;
};

/// Calls make(work), which returns Edited, as run_work() does. Warns if attributes were dropped.
template <class Make>
DagPointer run_edit(const Make& make) {
  const Edited edited = run_work(make);
  if (edited.drops)
    warn(edited.dag->look().has_colors()
             ? "the result has no normals and materials of its source"
             : "the result has no colours, normals and materials of its source");
  return edited.dag;
}

/// Returns the model with the colours that visit(add) adds: add(voxel, colour), which may give a
/// voxel several colours: it gets their mean, in linear light. Each voxel of `dag` needs one.
template <class Visit>
DagPointer colored_dag(VdagMetadata metadata, Work work, const Visit& visit) {
  constexpr std::size_t kColorsInMemory = std::size_t{1} << 26;
  ColoredVoxelBuilder builder(metadata.grid.levels, kColorsInMemory,
                              std::filesystem::temp_directory_path(), work);
  std::uint64_t count = 0;
  visit([&](Vec3i voxel, Value8 color) {
    work.poll_seldom(count++);
    builder.add(voxel, {color.x, color.y, color.z});
  });
  auto [dag, attributes] = builder.finish(0);  // The colours are not coded with a loss again.
  metadata.attributes.resolution = metadata.grid.resolution();
  metadata.attributes.colors = {0, attributes.color_errors.squared};
  return std::make_shared<Dag>(
      DagModel(std::move(dag), std::move(attributes), std::move(metadata)));
}

/// Returns the model of an edit; its voxels keep the attributes of `models`.
DagPointer edited_dag(std::span<const PlacedModel> models, Svdag dag, const Grid& grid,
                      const std::string& edit, Work work, const NewValues& new_values = {}) {
  return std::make_shared<Dag>(edited(models, std::move(dag), grid, edit, {new_values, {}}, work));
}

/// Returns the model of an edit in the grid of its source. Voxels have moved like PlacedModel.
DagPointer edited_dag(const Dag& source, Svdag dag, const std::string& edit, Work work,
                      const NewValues& new_values = {}, const Orientation& orientation = {},
                      Vec3i offset = {}) {
  const PlacedModel placed{source.model(), orientation, offset};
  return edited_dag({&placed, 1}, std::move(dag), source.grid(), edit, work, new_values);
}

DagPointer combined(const Dag& a, const Dag& b, SetOperation operation, const char* name) {
  return run_work([&](Work work) {
    const AlignedModels aligned(a.model(), b.model(), work);
    return edited_dag(aligned.placed(operation), aligned.result(operation),
                      aligned.grid_of(operation),
                      std::string(name) + " " + b.model().metadata().source.name, work);
  });
}

using GivenColor = std::optional<std::array<std::uint8_t, 3>>;

NewValues new_values_of(const GivenColor& color, std::optional<std::uint16_t> material) {
  NewValues values;
  if (color) values.color = Value8{(*color)[0], (*color)[1], (*color)[2]};
  values.material = material;
  return values;
}

Neighbours neighbours_of(int count) {
  if (count == 6) return Neighbours::k6;
  if (count == 26) return Neighbours::k26;
  throw py::value_error("neighbours must be 6 or 26");
}

DagPointer grown(const Dag& dag, int steps, int neighbours, bool is_dilation,
                 const NewValues& new_values = {}) {
  if (steps < 1) throw py::value_error("steps must be at least 1");
  const Neighbours kind = neighbours_of(neighbours);
  return run_work([&](Work work) {
    Svdag result =
        is_dilation ? dilate(dag.view(), steps, kind, work) : erode(dag.view(), steps, kind, work);
    return edited_dag(dag, std::move(result),
                      (is_dilation ? "dilated by " : "eroded by ") + std::to_string(steps), work,
                      new_values);
  });
}

std::string text_of(Vec3i v) {
  return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
}

DagPointer cropped(const Dag& dag, const Window& window) {
  const Box3i box = window_of(dag, window);
  return run_work([&](Work work) {
    return edited_dag(dag, crop(dag.view(), box, work),
                      "cropped to " + text_of(box.lo) + "," + text_of(box.hi), work);
  });
}

DagPointer shifted(const Dag& dag, const std::array<std::int32_t, 3>& offset, bool drop_outside) {
  const Vec3i by{offset[0], offset[1], offset[2]};
  return run_work([&](Work work) {
    Svdag moved = shift(dag.view(), by, dag.grid().levels, work);
    const std::uint64_t lost =
        dag.model().metadata().counts.voxels - count_svdag(moved.view()).voxels;
    if (lost != 0 && !drop_outside)
      throw Error(std::to_string(lost) +
                  " voxels would leave the grid: drop_outside=True leaves them out");
    return edited_dag(dag, std::move(moved), "shifted by " + text_of(by), work, {}, {}, by);
  });
}

DagPointer reoriented(const Dag& dag, const Orientation& orientation, const std::string& edit) {
  return run_work([&](Work work) {
    return edited_dag(dag, reorient(dag.view(), orientation, work), edit, work, {}, orientation);
  });
}

DagPointer coarser(const Dag& dag, std::int64_t resolution) {
  const int levels = levels_of(resolution);
  if (levels > dag.grid().levels) throw py::value_error("resolution exceeds that of the DAG");
  return run_edit([&](Work work) -> Edited {
    Svdag coarse = coarsen(dag.view(), levels, work);
    VdagMetadata metadata = coarser_metadata(dag.model().metadata(), coarse.view());
    metadata.attributes = {};
    const LookView look = dag.look();
    if (!look.has_colors())
      return {std::make_shared<Dag>(DagModel(std::move(coarse), {}, std::move(metadata))),
              !look.is_empty()};
    LookReader reader(look);
    const int fine = dag.grid().levels, cut = fine - levels;
    const DagPointer colored = colored_dag(metadata, work, [&](const auto& add) {
      for_each_voxel(dag.view(), whole_grid(fine), [&](Vec3i v) {
        add({v.x >> cut, v.y >> cut, v.z >> cut}, reader.read(v, fine).color);
      });
    });
    return {colored, look.has_normals() || look.has_materials()};
  });
}

py::array_t<std::uint64_t> component_table(const Dag& dag, int neighbours) {
  const Neighbours kind = neighbours_of(neighbours);
  const std::vector<ComponentSizes> sizes =
      run_work([&](Work work) { return component_sizes(dag.view(), kind, work); });
  py::array_t<std::uint64_t> table({static_cast<py::ssize_t>(sizes.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    table.mutable_at(static_cast<py::ssize_t>(i), 0) = sizes[i].voxels;
    table.mutable_at(static_cast<py::ssize_t>(i), 1) = sizes[i].count;
  }
  return table;
}

DagPointer large_components(const Dag& dag, std::uint64_t least, int neighbours) {
  const Neighbours kind = neighbours_of(neighbours);
  return run_work([&](Work work) {
    return edited_dag(dag, keep_components(dag.view(), least, kind, work),
                      "components of at least " + std::to_string(least) + " voxels", work);
  });
}

void add_moves(DagClass& dag) {
  dag.def("crop", &cropped, py::arg("window"),
          "Keep the voxels in ((x0, y0, z0), (x1, y1, z1)): the first voxel, and one past the last "
          "on each axis. The grid stays.")
      .def("shift", &shifted, py::arg("offset"), py::kw_only(), py::arg("drop_outside") = false,
           "Move the voxels by (x, y, z) voxels. Voxels that would leave the grid are an error, or "
           "left out.")
      .def(
          "mirror",
          [](const Dag& d, const std::string& axis) {
            return reoriented(d, mirrored(axis_of(axis)), "mirrored along " + axis);
          },
          py::arg("axis"), "Mirror along 'x', 'y' or 'z' in the middle of the grid.")
      .def(
          "rotate",
          [](const Dag& d, const std::string& axis, int turns) {
            return reoriented(
                d, rotated(axis_of(axis), turns % 4),
                "rotated about " + axis + " by " + std::to_string(turns) + " quarter turns");
          },
          py::arg("axis"), py::arg("turns") = 1,
          "Rotate about 'x', 'y' or 'z' in the middle of the grid by quarter turns: one about z "
          "takes x to y.")
      .def("coarsen", &coarser, py::arg("resolution"),
           "The same place in larger voxels, which are set if the cell has voxels. A voxel has the "
           "mean colour of its voxels.")
      .def(
          "components", &component_table, py::kw_only(), py::arg("neighbours") = 26,
          "The sizes of connected components, the largest first: (K, 2) uint64, a number of voxels "
          "and how many components have it.")
      .def("keep_components", &large_components, py::arg("least"), py::kw_only(),
           py::arg("neighbours") = 26, "Keep the components of at least so many voxels.");
}

}  // namespace

void add_edits(DagClass& dag) {
  add_moves(dag);
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
          "dilate",
          [](const Dag& d, int steps, int n, const GivenColor& color,
             std::optional<std::uint16_t> material) {
            return grown(d, steps, n, true, new_values_of(color, material));
          },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          py::arg("color") = py::none(), py::arg("material") = py::none(),
          "Add the voxels that are `steps` steps from voxels, to 6 or 26 neighbours. They take the "
          "colours, normals and materials of the nearest voxels, or the given `color` (red, green, "
          "blue) and `material`.")
      .def(
          "erode", [](const Dag& d, int steps, int n) { return grown(d, steps, n, false); },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          "Remove the voxels that are `steps` steps from empty places.")
      .def(
          "fill_cavities",
          [](const Dag& d, const GivenColor& color, std::optional<std::uint16_t> material) {
            return run_work([&](Work work) {
              return edited_dag(d, fill_cavities(d.view(), work), "filled", work,
                                new_values_of(color, material));
            });
          },
          py::kw_only(), py::arg("color") = py::none(), py::arg("material") = py::none(),
          "Fill the empty places that no way over faces connects with the sides of the grid. "
          "Values of new voxels are those of dilate().");
}

}  // namespace voxdag::python
