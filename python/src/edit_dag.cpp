/// DAGs from DAGs: set operations, moves, dilation, components. Results keep the attributes of
/// their voxels.
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <optional>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/carve.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/hollow.hpp"
#include "voxdag/algebra/query/containing_voxel.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/model/aligned_models.hpp"
#include "voxdag/file/model/edited.hpp"
#include "voxdag/formats/exports/export_scene.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

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

DagPointer hollowed(const Dag& dag, double wall, const std::vector<std::array<double, 4>>& drains) {
  const Grid& grid = dag.grid();
  if (!(wall >= grid.voxel_size) || !std::isfinite(wall))
    throw py::value_error("wall must be at least the side of a voxel, " +
                          py::cast<std::string>(py::str(py::float_(grid.voxel_size))));
  std::vector<Drain> holes;
  for (const auto& [x, y, z, radius] : drains) {
    if (!is_finite(Vec3d{x, y, z}) || !(radius > 0) || !std::isfinite(radius))
      throw py::value_error("a drain must be x, y, z and a radius above 0");
    holes.push_back(
        {(Vec3d{x, y, z} - grid.origin) * (1 / grid.voxel_size), radius / grid.voxel_size});
  }
  return run_work([&](Work work) {
    return edited_dag(dag, hollow(dag.view(), wall / grid.voxel_size, holes, work), "hollow", work);
  });
}

DagPointer carved(const Dag& dag, const std::array<double, 3>& from,
                  const std::array<double, 2>& capsule, const std::optional<std::string>& up,
                  bool solid) {
  const auto [height, radius] = capsule;
  if (!(height > 0 && radius >= 0) || !std::isfinite(height) || !std::isfinite(radius))
    throw py::value_error("capsule must be a height above 0 and a radius of 0 or more");
  const Vec3d at{from[0], from[1], from[2]};
  if (!is_finite(at)) throw py::value_error("start must be finite");
  const Grid& grid = dag.grid();
  const int axis =
      axis_of(up.value_or(std::string(1, up_of(dag.model().metadata()).value_or('y'))));
  const Vec3i half = half_of_capsule(height, radius, axis, grid.voxel_size);
  return run_work([&](Work work) {
    return edited_dag(dag,
                      carve(dag.view(), voxel_at(grid, at), half,
                            solid ? CarveForm::kSolid : CarveForm::kWall, work),
                      "carved", work);
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
  return run_work([&](Work work) {
    Svdag coarse = coarsen(dag.view(), levels, work);
    VdagMetadata metadata = coarser_metadata(dag.model().metadata(), coarse.view());
    const DagAttributesView fine = dag.model().attributes();
    DagAttributes kept = coarsen_attributes({dag.view(), fine}, coarse.view(), {}, work);
    if (fine.is_empty())
      metadata.attributes = {};
    else
      describe_coarser(metadata.attributes, levels);
    return std::make_shared<Dag>(
        DagModel(std::move(coarse), std::move(kept), std::move(metadata), work));
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
          R"(Returns the voxels in a box. The grid stays.

window: ((x0, y0, z0), (x1, y1, z1)), the first voxel and one past the last on each axis.)")
      .def("shift", &shifted, py::arg("offset"), py::kw_only(), py::arg("drop_outside") = false,
           R"(Moves the voxels. The grid stays.

offset: (x, y, z), in voxels.
drop_outside: leave out voxels that would leave the grid; without it, they raise ValueError.)")
      .def(
          "mirror",
          [](const Dag& d, const std::string& axis) {
            return reoriented(d, mirrored(axis_of(axis)), "mirrored along " + axis);
          },
          py::arg("axis"), R"(Mirrors the voxels in the middle of the grid.

axis: 'x', 'y' or 'z', which changes direction.)")
      .def(
          "rotate",
          [](const Dag& d, const std::string& axis, int turns) {
            if (turns < -3 || turns > 3)
              throw py::value_error("turns must be -3 to 3 quarter turns, not " +
                                    std::to_string(turns));
            return reoriented(
                d, rotated(axis_of(axis), turns),
                "rotated about " + axis + " by " + std::to_string(turns) + " quarter turns");
          },
          py::arg("axis"), py::arg("turns") = 1,
          R"(Rotates the voxels about the middle of the grid.

axis: 'x', 'y' or 'z'. turns: quarter turns, -3 to 3; one about z takes x to y.)")
      .def("coarsen", &coarser, py::arg("resolution"),
           R"(Joins voxels to larger ones, at the same place in the world.

resolution: voxels per side of the new grid, a power of two. A voxel of it is set if its place has
voxels, and has the values that the DAG stores for that place: the mean of the voxels' colours, normals
and channels, within the bounds of the DAG's encoding, and the most frequent material.)")
      .def("components", &component_table, py::kw_only(), py::arg("neighbours") = 26,
           R"(Counts connected components, the largest first. Returns (K, 2) uint64.

A row is a number of voxels, and how many components have it.
neighbours: 6 (voxels share a face) or 26 (a face, an edge or a corner).)")
      .def("keep_components", &large_components, py::arg("least"), py::kw_only(),
           py::arg("neighbours") = 26, R"(Returns the voxels of large components.

least: voxels that a component must have. neighbours: as for components().)");
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
  add("__or__", SetOperation::kUnion, "union with", "Returns the voxels of either DAG.");
  add("__and__", SetOperation::kIntersection, "intersection with",
      "Returns the voxels of both DAGs.");
  add("__sub__", SetOperation::kDifference, "minus", "Returns the voxels of the first DAG only.");
  add("__xor__", SetOperation::kSymmetric, "symmetric difference with",
      "Returns the voxels of one DAG only.");
  dag.def(
         "__eq__",
         [](const Dag& a, const Dag& b) {
           const SvdagView x = a.view(), y = b.view();
           return a.grid() == b.grid() && x.node_words() == y.node_words() &&
                  x.leaf_block_count == y.leaf_block_count &&
                  std::equal(x.nodes, x.nodes + x.node_words(), y.nodes) &&
                  std::equal(x.leaf_blocks, x.leaf_blocks + x.leaf_block_count, y.leaf_blocks);
         },
         py::is_operator(), "Tells whether both have the same voxels at the same place.")
      .def(
          "dilate",
          [](const Dag& d, int steps, int n, const GivenColor& color,
             std::optional<std::uint16_t> material) {
            return grown(d, steps, n, true, new_values_of(color, material));
          },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          py::arg("color") = py::none(), py::arg("material") = py::none(),
          R"(Adds the voxels that are at most `steps` steps from voxels.

neighbours: 6 (a step passes a face) or 26 (a face, an edge or a corner).
color, material: of new voxels, (red, green, blue) from 0 to 255 and an id; default: those of the
nearest voxel.)")
      .def(
          "erode", [](const Dag& d, int steps, int n) { return grown(d, steps, n, false); },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          R"(Removes the voxels that are at most `steps` steps from empty places.

neighbours: as for dilate(). Places outside of the grid are empty.)")
      .def("hollow", &hollowed, py::arg("wall"), py::arg("drains") = py::list(),
           R"(Removes the inside of a solid, for printing.

wall: in world units. A voxel stays if the distance from its centre to the cube of the nearest empty
place is at most this; distance_field(signed=True) shows the distances.
drains: (N, 4), x, y, z and radius of round holes, in world units, from a point on the surface to the
nearest voxel that was removed.
Raises ValueError if no voxel is deeper than the wall, or if a drain does not open the cavity.)")
      .def("carve", &carved, py::arg("start"), py::arg("capsule"), py::kw_only(),
           py::arg("up") = py::none(), py::arg("solid") = false,
           R"(Keeps the walls of the space that an upright capsule can reach.

start: (x, y, z), where its middle begins; capsule: (height, radius); in world units.
up: the axis of the capsule, "x", "y" or "z"; default: the one that is up in the file, else y.
solid: fill the box of the space, not only a wall of one voxel.
Raises ValueError if voxels are in the way of the capsule at its start.)")
      .def(
          "fill_cavities",
          [](const Dag& d, const GivenColor& color, std::optional<std::uint16_t> material) {
            return run_work([&](Work work) {
              return edited_dag(d, fill_cavities(d.view(), work), "filled", work,
                                new_values_of(color, material));
            });
          },
          py::kw_only(), py::arg("color") = py::none(), py::arg("material") = py::none(),
          R"(Fills the empty places that no way over faces connects with the sides of the grid.

color, material: as for dilate().)");
}

}  // namespace voxdag::python
