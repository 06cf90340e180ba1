/// Questions about voxels: contains, nearest, coords, arrays, heights, distances, surfaces.
#include <pybind11/stl.h>

#include <cmath>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/algebra/query/containing_voxel.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/height_map.hpp"
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
            return static_cast<double>(d.model().metadata().counts.voxels) *
                   std::pow(d.grid().voxel_size, 3);
          },
          "The volume of the voxels, in cubes of the world unit.");
  dag.def("contains", &contains, py::arg("points"),
          "Whether points (N, 3), in world units, lie in voxels. Returns (N,) bool.")
      .def("nearest", &nearest, py::arg("points"),
           "The voxels nearest to points (N, 3), in world units. Returns a dict of arrays: voxel "
           "(N, 3) int32; distance (N,) float64 to the cube of the voxel, 0 in it. Without voxels: "
           "-1 and inf.")
      .def("coords", &coords, py::arg("window") = none,
           "The voxels, (N, 3) int32, in Morton order. window: ((x0, y0, z0), (x1, y1, z1)), the "
           "first voxel and one past the last on each axis.")
      .def("colors", &colors, py::arg("voxels"),
           "The colours of voxels (N, 3), as (N, 3) uint8, sRGB.")
      .def("to_dense", &to_dense, py::arg("window") = none,
           "A dense array of bool, [x, y, z], of the window or the whole grid.")
      .def("heights", &heights, py::arg("axis"), py::kw_only(), py::arg("low") = false,
           "The coordinate of the last voxel of each column along axis 'x', 'y' or 'z', or of the "
           "first one if low; -1 in empty columns. Returns (N, N) int32, indexed by the other two "
           "axes in the order x, y, z.")
      .def("distance_field", &distance_field, py::arg("window") = none, py::kw_only(),
           py::arg("signed") = false,
           "The distances, in world units, from the centres of the window's places to the nearest "
           "voxel: 0 in voxels, inf without voxels. signed: negative in voxels, where it is the "
           "distance to the nearest empty place. Returns float32, [x, y, z].")
      .def(
          "surface", &surface,
          "dict: faces, the numbers of outer faces of voxels across x, y and z; their area and the "
          "volume of the voxels, in world units.");
}

}  // namespace voxdag::python
