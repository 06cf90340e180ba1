/// Rays: cast and occluded, of Dag and of Snapshot.
#include <cmath>
#include <limits>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/core/float_origin.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

/// Returns the place from which the origins of rays are measured, because rays are in float32.
Vec3d near(const SceneParts& dag) { return float_origin(dag.grid.bounds()); }

std::vector<Vec3f> points_of(const SceneParts& dag, const ArrayLike& array, const char* name) {
  const Vec3d origin = near(dag);
  std::vector<Vec3f> points;
  for (const Vec3d p : rows_of<double>(array, name))
    points.push_back(static_cast<Vec3f>(p - origin));
  return points;
}

/// Returns the rays of two arrays of shape (N, 3), or of one row and N.
std::vector<Ray> rays_of(const SceneParts& dag, const ArrayLike& origins,
                         const ArrayLike& directions, float t_min, float t_max) {
  const std::vector<Vec3f> from = points_of(dag, origins, "origins");
  const std::vector<Vec3f> along = rows_of<float>(directions, "directions");
  const std::size_t count = std::max(from.size(), along.size());
  if ((from.size() != count && from.size() != 1) || (along.size() != count && along.size() != 1))
    throw py::value_error("origins and directions must have as many rows as each other, or one");
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i)
    rays[i] = {from[from.size() == 1 ? 0 : i], t_min, along[along.size() == 1 ? 0 : i], t_max};
  return rays;
}

std::vector<Hit> cast_all(const SceneParts& dag, const std::vector<Ray>& rays) {
  return run_work([&](Work work) {
    std::vector<Hit> hits(rays.size());
    Grid grid = dag.grid;
    grid.origin = grid.origin - near(dag);
    trace_batch(dag.scene, grid, rays, hits, work);
    return hits;
  });
}

py::dict cast(const SceneParts& dag, const ArrayLike& origins, const ArrayLike& directions,
              float t_min, float t_max) {
  const std::vector<Hit> hits = cast_all(dag, rays_of(dag, origins, directions, t_min, t_max));
  std::vector<float> t(hits.size());
  std::vector<Vec3i> voxels(hits.size(), Vec3i{-1, -1, -1});
  std::vector<std::int8_t> faces(hits.size(), -1);
  std::vector<Value8> colors(dag.look.has_colors() ? hits.size() : 0);
  LookReader look(dag.look);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    t[i] = hit.hit ? hit.t : std::numeric_limits<float>::infinity();
    if (!hit.hit) continue;
    voxels[i] = hit.voxel;
    faces[i] = static_cast<std::int8_t>(hit.face);
    if (!colors.empty()) colors[i] = look.read(hit.voxel, hit.level).color;
  }
  py::dict result;
  result["t_hit"] = array_of(t);
  result["voxel"] = array_of(voxels);
  result["face"] = array_of(faces);
  if (dag.look.has_colors()) result["color"] = array_of(colors);
  return result;
}

py::array_t<bool> occluded(const SceneParts& dag, const ArrayLike& origins,
                           const ArrayLike& targets) {
  const std::vector<Vec3f> from = points_of(dag, origins, "origins"),
                           to = points_of(dag, targets, "targets");
  if (from.size() != to.size() && from.size() != 1 && to.size() != 1)
    throw py::value_error("origins and targets must have as many rows as each other, or one");
  std::vector<Ray> rays(std::max(from.size(), to.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3f begin = from[from.size() == 1 ? 0 : i];
    rays[i] = {begin, 0, to[to.size() == 1 ? 0 : i] - begin, 1};
  }
  const std::vector<Hit> hits = cast_all(dag, rays);
  py::array_t<bool> result(static_cast<py::ssize_t>(hits.size()));
  for (std::size_t i = 0; i < hits.size(); ++i)
    result.mutable_at(static_cast<py::ssize_t>(i)) = hits[i].hit;
  return result;
}

template <class Shown, class Class>
void define_rays(Class& shown) {
  shown
      .def(
          "cast",
          [](const Shown& of, const ArrayLike& origins, const ArrayLike& directions, float t_min,
             float t_max) { return cast(of.parts(), origins, directions, t_min, t_max); },
          py::arg("origins"), py::arg("directions"), py::kw_only(), py::arg("t_min") = 0.0f,
          py::arg("t_max") = std::numeric_limits<float>::infinity(),
          R"(Casts rays and returns what they hit first, as a dict of arrays.

origins, directions: (N, 3) real numbers in world units, or one row for all rays.
t_min, t_max: the part of the rays that counts, in lengths of the direction.
t_hit: (N,) float32, in lengths of the direction; inf for a miss.
voxel: (N, 3) int32; -1 for a miss.
face: (N,) int8, 0 to 5 for -x, +x, -y, +y, -z, +z; -1 for a miss or a ray that starts inside.
color: (N, 3) uint8, sRGB, if the DAG has colours.)")
      .def(
          "occluded",
          [](const Shown& of, const ArrayLike& origins, const ArrayLike& targets) {
            return occluded(of.parts(), origins, targets);
          },
          py::arg("origins"), py::arg("targets"),
          R"(Tells whether voxels lie on the segments from origins to targets. Returns (N,) bool.

origins, targets: (N, 3) real numbers in world units, or one row for all segments.)");
}

}  // namespace

void add_rays(DagClass& dag) { define_rays<Dag>(dag); }
void add_rays(SnapshotClass& snapshot) { define_rays<Snapshot>(snapshot); }

}  // namespace voxdag::python
