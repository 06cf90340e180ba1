/// Questions about voxels: contains, nearest, coords, arrays, heights, distances, surfaces.
#include <pybind11/stl.h>

#include <cmath>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/query/containing_voxel.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/height_map.hpp"
#include "voxdag/algebra/query/local_thickness.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/query/surface_area.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

Vec3d to_grid(const Grid& grid, Vec3d world) {
  return (world - grid.origin) * (1 / grid.voxel_size);
}

py::array_t<bool> contains(const Dag& dag, const ArrayLike& points) {
  const std::vector<Vec3d> places = rows_of<double>(points, "points");
  py::array_t<bool> result(static_cast<py::ssize_t>(places.size()));
  bool* const inside = result.mutable_data();
  run_work([&](Work work) {
    polled_for(places.size(), 4096, work, "contains", [&](std::size_t i) {
      inside[i] =
          svdag_contains(dag.view(), containing_voxel(dag.grid(), places[i]), dag.grid().levels);
    });
    return 0;
  });
  return result;
}

py::dict nearest(const Dag& dag, const ArrayLike& points) {
  const std::vector<Vec3d> places = rows_of<double>(points, "points");
  std::vector<Vec3i> voxels(places.size(), Vec3i{-1, -1, -1});
  std::vector<double> distances(places.size(), HUGE_VAL);
  run_work([&](Work work) {
    polled_for(places.size(), 256, work, "nearest", [&](std::size_t i) {
      const auto found = nearest_voxel(dag.view(), to_grid(dag.grid(), places[i]));
      if (!found) return;
      voxels[i] = found->voxel;
      distances[i] = std::sqrt(found->distance2) * dag.grid().voxel_size;
    });
    return 0;
  });
  py::dict result;
  result["voxel"] = array_of(voxels);
  result["distance"] = array_of(distances);
  return result;
}

py::array_t<std::int32_t> coords(const Dag& dag, const std::optional<Window>& window) {
  const Box3i box = window_of(dag, window);
  return array_of(run_work([&](Work work) {
    std::vector<Vec3i> voxels;
    for_each_voxel(dag.view(), box, [&](Vec3i voxel) {
      work.poll_seldom(voxels.size());
      voxels.push_back(voxel);
    });
    return voxels;
  }));
}

py::object colors(const Dag& dag, const ArrayLike& voxels) {
  LookReader look(dag.look());
  if (!look.has_colors()) throw py::value_error("the DAG has no colours");
  std::vector<Value8> values;
  for (const Vec3i voxel : voxels_of(voxels, "voxels"))
    values.push_back(look.read(voxel, dag.grid().levels).color);
  return array_of(values);
}

py::array_t<bool> to_dense(const Dag& dag, const std::optional<Window>& window) {
  const Box3i box = window_of(dag, window);
  const Vec3<py::ssize_t> size(box.hi - box.lo);
  py::array_t<bool> dense({size.x, size.y, size.z});
  bool* const data = dense.mutable_data();
  run_work([&](Work work) {
    std::fill_n(data, size.x * size.y * size.z, false);
    std::uint64_t done = 0;
    for_each_voxel(dag.view(), box, [&](Vec3i voxel) {
      work.poll_seldom(done++);
      const Vec3<py::ssize_t> at(voxel - box.lo);
      data[(at.x * size.y + at.y) * size.z + at.z] = true;
    });
    return 0;
  });
  return dense;
}

py::array_t<std::int32_t> heights(const Dag& dag, const std::string& axis, bool is_low) {
  const int along = axis_of(axis);
  const std::vector<std::int32_t> map = run_work([&](Work work) {
    return height_map(dag.view(), along, is_low ? HeightSide::kLow : HeightSide::kHigh, work);
  });
  const auto side = static_cast<py::ssize_t>(dag.grid().resolution());
  py::array_t<std::int32_t> result({side, side});
  for (py::ssize_t v = 0; v < side; ++v)
    for (py::ssize_t u = 0; u < side; ++u)
      result.mutable_at(u, v) = map[static_cast<std::size_t>(u + side * v)];
  return result;
}

py::array_t<float> distance_field(const Dag& dag, const std::optional<Window>& window,
                                  bool is_signed) {
  const Box3i box = window_of(dag, window);
  const Vec3<py::ssize_t> size(box.hi - box.lo);
  const auto unit = static_cast<float>(dag.grid().voxel_size);
  std::vector<float> distances = run_work([&](Work work) {
    return is_signed ? signed_distance_field(dag.view(), box, work)
                     : voxdag::distance_field(dag.view(), box, work);
  });
  for (float& distance : distances) distance *= unit;
  // The library's x runs fastest, as in Fortran's arrays.
  const py::array_t<float, py::array::f_style> field({size.x, size.y, size.z}, distances.data());
  return Array<float>::ensure(field);
}

py::array_t<float> thickness(const Dag& dag, const std::optional<Window>& window) {
  const Box3i box = window_of(dag, window);
  const Vec3<py::ssize_t> size(box.hi - box.lo);
  py::array_t<float> result({size.x, size.y, size.z});
  float* const data = result.mutable_data();
  run_work([&](Work work) {
    std::fill_n(data, size.x * size.y * size.z, 0.0f);
    const LocalThickness field = local_thickness(dag.view(), work);
    const Vec3<std::size_t> in_field(field.box.hi - field.box.lo);
    for_each_voxel(dag.view(), box, [&](Vec3i voxel) {
      const Vec3<py::ssize_t> to(voxel - box.lo);
      const Vec3<std::size_t> from(voxel - field.box.lo);
      const std::uint32_t square =
          field.squares[(from.z * in_field.y + from.y) * in_field.x + from.x];
      data[(to.x * size.y + to.y) * size.z + to.z] =
          static_cast<float>(std::sqrt(static_cast<double>(square)) * dag.grid().voxel_size);
    });
    return 0;
  });
  return result;
}

py::tuple tuple_of(Vec3d v) { return py::make_tuple(v.x, v.y, v.z); }

VoxelMoments moments(const Dag& dag) {
  return run_work([&](Work work) { return moments_of(dag.view(), work); });
}

py::object bounds(const Dag& dag) {
  const VoxelMoments found = moments(dag);
  if (found.voxels == 0) return py::none();
  const Grid& grid = dag.grid();
  return py::make_tuple(tuple_of(grid.to_world(Vec3d(found.bounds.lo))),
                        tuple_of(grid.to_world(Vec3d(found.bounds.hi))));
}

py::object centre(const Dag& dag) {
  const VoxelMoments found = moments(dag);
  if (found.voxels == 0) return py::none();
  return tuple_of(dag.grid().to_world(found.centre));
}

py::dict surface(const Dag& dag) {
  const VoxelSurface found = run_work([&](Work work) { return surface_of(dag.view(), work); });
  const double unit = dag.grid().voxel_size;
  py::dict result;
  result["faces"] = py::make_tuple(found.faces[0], found.faces[1], found.faces[2]);
  result["area"] = static_cast<double>(found.all_faces()) * unit * unit;
  result["volume"] = static_cast<double>(found.voxels) * unit * unit * unit;
  return result;
}

}  // namespace

void add_queries(DagClass& dag) {
  const auto none = py::none();
  dag.def_property_readonly("bounds", &bounds,
                            "The box of the voxels in world units: ((x0, y0, z0), (x1, y1, z1)); "
                            "None without voxels.")
      .def_property_readonly(
          "centre", &centre,
          "The centre of mass of the voxels in world units; None without voxels.")
      .def_property_readonly(
          "volume",
          [](const Dag& d) {
            const double side = d.grid().voxel_size;
            return static_cast<double>(d.model().metadata().counts.voxels) * (side * side * side);
          },
          "The volume of the voxels, in cubes of the world unit.");
  dag.def("contains", &contains, py::arg("points"),
          R"(Tells whether points lie in voxels. Returns (N,) bool.

points: (N, 3) real numbers in world units.)")
      .def("nearest", &nearest, py::arg("points"),
           R"(Finds the voxels nearest to points. Returns a dict of arrays.

points: (N, 3) real numbers in world units.
voxel: (N, 3) int32; -1 if the DAG has no voxels.
distance: (N,) float64 to the cube of the voxel, in world units: 0 in it, inf without voxels.)")
      .def("coords", &coords, py::arg("window") = none,
           R"(Returns the voxels, (N, 3) int32, in Morton order.

window: ((x0, y0, z0), (x1, y1, z1)), the first voxel and one past the last on each axis; default:
the grid.)")
      .def("colors", &colors, py::arg("voxels"),
           R"(Returns the colours of voxels, (N, 3) uint8, sRGB.

voxels: (N, 3) whole numbers. Raises ValueError if the DAG has no colours.)")
      .def("to_dense", &to_dense, py::arg("window") = none,
           R"(Returns a dense array of bool, [x, y, z]: whether places are voxels.

window: as for coords().)")
      .def("heights", &heights, py::arg("axis"), py::kw_only(), py::arg("low") = false,
           R"(Returns the last voxel of each column, (N, N) int32; -1 in empty columns.

axis: 'x', 'y' or 'z', along which columns run. The result has its coordinate, and is indexed by the
other two axes in the order x, y, z.
low: return the first voxel of each column.)")
      .def("distance_field", &distance_field, py::arg("window") = none, py::kw_only(),
           py::arg("signed") = false,
           R"(Returns the distances from places to the nearest voxel, float32, [x, y, z].

They are in world units, from the centre of a place to the cube of a voxel: 0 in voxels, inf without
voxels.
window: as for coords().
signed: let distances be negative in voxels, where they are those to the nearest empty place.)")
      .def(
          "thickness", &thickness, py::arg("window") = none,
          R"(Measures the thickness at each voxel of a solid, float32, [x, y, z]; 0 in empty places.

It is the diameter, in world units, of the largest ball inside that holds the centre of the voxel and
has its own centre in that of a voxel: plates of an even number of voxels measure one voxel less.
window: as for coords().)")
      .def("surface", &surface,
           R"(Measures the surface. Returns a dict.

faces: the numbers of outer faces of voxels across x, y and z.
area: of these faces, in squares of the world unit.
volume: of the voxels, in cubes of the world unit.)");
}

}  // namespace voxdag::python
