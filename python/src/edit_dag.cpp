/// DAGs from DAGs: set operations, moves, dilation, components. Results keep the colours if each of
/// their voxels has one, and warn of attributes that they drop.
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
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

/// Returns the model of an edit without attributes.
DagPointer plain_dag(const Dag& source, Svdag dag, const Grid& grid, const std::string& edit) {
  return std::make_shared<Dag>(edited(source.model(), std::move(dag), grid, edit));
}

/// Returns the model of an edit. source_of(voxel) is the voxel of `source` that a voxel of `dag`
/// was: it has its colour.
template <class SourceOf>
Edited moved_dag(const Dag& source, Svdag dag, const std::string& edit, Work work,
                 const SourceOf& source_of) {
  const LookView look = source.look();
  const DagPointer plain = plain_dag(source, std::move(dag), source.grid(), edit);
  if (!look.has_colors()) return {plain, !look.is_empty()};
  LookReader reader(look);
  const int levels = source.grid().levels;
  const DagPointer colored = colored_dag(plain->model().metadata(), work, [&](const auto& add) {
    for_each_voxel(plain->view(), whole_grid(levels),
                   [&](Vec3i voxel) { add(voxel, reader.read(source_of(voxel), levels).color); });
  });
  return {colored, look.has_normals() || look.has_materials()};
}

/// Returns the model of an edit that adds voxels, which have no colours.
Edited without_attributes(const Dag& source, Svdag dag, const std::string& edit) {
  return {plain_dag(source, std::move(dag), source.grid(), edit), !source.look().is_empty()};
}

/// Returns the model of an edit that only removes voxels.
Edited reduced_dag(const Dag& source, Svdag dag, const std::string& edit, Work work) {
  return moved_dag(source, std::move(dag), edit, work, [](Vec3i voxel) { return voxel; });
}

/// Returns the model of a combination; voxels have the colours of `a`, else of `b`.
Edited combined_dag(const Dag& a, const Dag& b, const DagPointer& plain, bool needs_b, Work work) {
  const LookView look_a = a.look(), look_b = b.look();
  const bool has_normals = look_a.has_normals() || look_a.has_materials();
  if (!look_a.has_colors() || (needs_b && !look_b.has_colors()))
    return {plain, has_normals || look_a.has_colors() || (needs_b && !look_b.is_empty())};
  LookReader reader_a(look_a), reader_b(look_b);
  const Grid& grid = plain->grid();
  const DagPointer colored = colored_dag(plain->model().metadata(), work, [&](const auto& add) {
    for_each_voxel(plain->view(), whole_grid(grid.levels), [&](Vec3i voxel) {
      const Vec3d centre = grid.to_world(Vec3d(voxel) + Vec3d{0.5, 0.5, 0.5});
      const Vec3i in_a = containing_voxel(a.grid(), centre);
      const bool is_of_a = !needs_b || svdag_contains(a.view(), in_a, a.grid().levels);
      add(voxel, is_of_a
                     ? reader_a.read(in_a, a.grid().levels).color
                     : reader_b.read(containing_voxel(b.grid(), centre), b.grid().levels).color);
    });
  });
  return {colored, has_normals || (needs_b && (look_b.has_normals() || look_b.has_materials()))};
}

DagPointer combined(const Dag& a, const Dag& b, SetOperation operation, const char* name) {
  const bool needs_b = operation == SetOperation::kUnion || operation == SetOperation::kSymmetric;
  return run_edit([&](Work work) {
    const AlignedModels aligned(a.model(), b.model(), work);
    const DagPointer plain = plain_dag(a, aligned.result(operation), aligned.grid_of(operation),
                                       std::string(name) + " " + b.model().metadata().source.name);
    return combined_dag(a, b, plain, needs_b, work);
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
  return run_edit([&](Work work) {
    if (!is_dilation)
      return reduced_dag(dag, erode(dag.view(), steps, kind, work),
                         "eroded by " + std::to_string(steps), work);
    return without_attributes(dag, dilate(dag.view(), steps, kind, work),
                              "dilated by " + std::to_string(steps));
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
  return run_edit([&](Work work) {
    return reduced_dag(dag, hollow(dag.view(), wall / grid.voxel_size, holes, work), "hollow",
                       work);
  });
}

std::string text_of(Vec3i v) {
  return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
}

DagPointer cropped(const Dag& dag, const Window& window) {
  const Box3i box = window_of(dag, window);
  return run_edit([&](Work work) {
    return reduced_dag(dag, crop(dag.view(), box, work),
                       "cropped to " + text_of(box.lo) + "," + text_of(box.hi), work);
  });
}

DagPointer shifted(const Dag& dag, const std::array<std::int32_t, 3>& offset, bool drop_outside) {
  const Vec3i by{offset[0], offset[1], offset[2]};
  return run_edit([&](Work work) {
    const Edited moved =
        moved_dag(dag, shift(dag.view(), by, dag.grid().levels, work), "shifted by " + text_of(by),
                  work, [by](Vec3i voxel) { return voxel - by; });
    const std::uint64_t lost =
        dag.model().metadata().counts.voxels - moved.dag->model().metadata().counts.voxels;
    if (lost != 0 && !drop_outside)
      throw Error(std::to_string(lost) +
                  " voxels would leave the grid: drop_outside=True leaves them out");
    return moved;
  });
}

DagPointer reoriented(const Dag& dag, const Orientation& orientation, const std::string& edit) {
  return run_edit([&](Work work) {
    return moved_dag(dag, reorient(dag.view(), orientation, work), edit, work, [&](Vec3i voxel) {
      return source_cell(orientation, voxel, dag.grid().levels);
    });
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
  return run_edit([&](Work work) {
    return reduced_dag(dag, keep_components(dag.view(), least, kind, work),
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
            return reoriented(
                d, rotated(axis_of(axis), turns % 4),
                "rotated about " + axis + " by " + std::to_string(turns) + " quarter turns");
          },
          py::arg("axis"), py::arg("turns") = 1,
          R"(Rotates the voxels about the middle of the grid.

axis: 'x', 'y' or 'z'. turns: quarter turns; one about z takes x to y.)")
      .def("coarsen", &coarser, py::arg("resolution"),
           R"(Joins voxels to larger ones, at the same place in the world.

resolution: voxels per side of the new grid, a power of two. A voxel of it is set if its place has
voxels, and gets their mean colour.)")
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
          "dilate", [](const Dag& d, int steps, int n) { return grown(d, steps, n, true); },
          py::arg("steps") = 1, py::kw_only(), py::arg("neighbours") = 26,
          R"(Adds the voxels that are at most `steps` steps from voxels.

neighbours: 6 (a step passes a face) or 26 (a face, an edge or a corner).)")
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
      .def(
          "fill_cavities",
          [](const Dag& d) {
            return run_edit([&](Work work) {
              return without_attributes(d, fill_cavities(d.view(), work), "filled");
            });
          },
          "Fills the empty places that no way over faces connects with the sides of the grid.");
}

}  // namespace voxdag::python
