/// Contacts of shapes with voxels: overlap, overlap_box, sweep, closest, signed_distance, of Dag
/// and of Snapshot.
#include "voxdag/algebra/contact/contacts.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "arrays.hpp"
#include "dag.hpp"
#include "run_work.hpp"
#include "voxdag/core/quaternion.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

using Rows = std::vector<Vec3d>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
const T& row_of(const std::vector<T>& rows, std::size_t i) {
  return rows[rows.size() == 1 ? 0 : i];
}

/// Returns the number of rows of several arrays, of which each has as many or one. Raises
/// ValueError.
std::size_t count_of(std::initializer_list<std::size_t> sizes, const char* names) {
  std::size_t count = 1;
  for (const std::size_t size : sizes)
    if (size != 1) count = size;
  for (const std::size_t size : sizes)
    if (size != 1 && size != count)
      throw py::value_error(std::string(names) + " must have as many rows as each other, or one");
  return count;
}

/// Returns the numbers of an array of `width` columns; a width of 1 is a number or the shape (N,).
std::vector<double> numbers_of(const ArrayLike& given, const char* name, py::ssize_t width) {
  kind_of(given, name, "iuf", "numbers");
  const bool is_good =
      width == 1 ? given.ndim() <= 1 : given.ndim() == 2 && given.shape(1) == width;
  if (!is_good)
    throw py::value_error(std::string(name) + (width == 1
                                                   ? " must be a number or have the shape (N,)"
                                                   : " must have the shape (N, 4)"));
  const Array<double> array(given);
  return {array.data(), array.data() + array.size()};
}

std::vector<Capsule> capsules_of(const ArrayLike& points, const ArrayLike& radius,
                                 const std::optional<ArrayLike>& to) {
  const Rows from = rows_of<double>(points, "points"),
             ends = to ? rows_of<double>(*to, "to") : from;
  const std::vector<double> radii = numbers_of(radius, "radius", 1);
  std::vector<Capsule> shapes(
      count_of({from.size(), radii.size(), ends.size()}, "points, radius and to"));
  for (std::size_t i = 0; i < shapes.size(); ++i)
    shapes[i] = {row_of(from, i), row_of(ends, i), row_of(radii, i)};
  return shapes;
}

template <class Shape>
py::array_t<bool> overlap_of(const ContactScene& scene, const std::vector<Shape>& shapes) {
  py::array_t<bool> result(static_cast<py::ssize_t>(shapes.size()));
  const std::span<bool> answers(result.mutable_data(), shapes.size());
  run_work([&](Work work) {
    overlaps(scene, shapes, answers, work);
    return 0;
  });
  return result;
}

py::array_t<bool> overlap_box(const ContactScene& scene, const ArrayLike& center,
                              const ArrayLike& half, const std::optional<ArrayLike>& turn) {
  const Rows centers = rows_of<double>(center, "center"), halves = rows_of<double>(half, "half");
  std::vector<std::array<Vec3d, 3>> turns{turned_axes(0, 0, 0, 1)};
  if (turn) {
    const std::vector<double> numbers = numbers_of(*turn, "turn", 4);
    turns.clear();
    for (std::size_t i = 0; i < numbers.size(); i += 4)
      turns.push_back(turned_axes(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]));
  }
  std::vector<OrientedBox> boxes(
      count_of({centers.size(), halves.size(), turns.size()}, "center, half and turn"));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto& axes = row_of(turns, i);
    boxes[i] = {row_of(centers, i), row_of(halves, i), {axes[0], axes[1], axes[2]}};
  }
  return overlap_of(scene, boxes);
}

/// Returns an array of a member of all answers.
template <class Answer, class T>
auto column_of(const std::vector<Answer>& answers, T Answer::*member) {
  std::vector<T> column(answers.size());
  std::transform(answers.begin(), answers.end(), column.begin(),
                 [&](const Answer& answer) { return answer.*member; });
  return array_of(column);
}

py::dict sweep_all(const ContactScene& scene, std::vector<Capsule> shapes,
                   const ArrayLike& motion) {
  Rows motions = rows_of<double>(motion, "motion");
  const std::size_t count = count_of({shapes.size(), motions.size()}, "points and motion");
  if (shapes.size() != count) shapes.assign(count, Capsule(shapes[0]));
  if (motions.size() != count) motions.assign(count, Vec3d(motions[0]));
  std::vector<SweepHit> hits(count);
  run_work([&](Work work) {
    sweep(scene, shapes, motions, hits, work);
    return 0;
  });
  for (SweepHit& hit : hits)
    if (!hit.hit) hit.t = kInfinity;
  py::dict result;
  result["t"] = column_of(hits, &SweepHit::t);
  result["voxel"] = column_of(hits, &SweepHit::voxel);
  result["point"] = column_of(hits, &SweepHit::point);
  result["normal"] = column_of(hits, &SweepHit::normal);
  return result;
}

py::dict closest_all(const ContactScene& scene, const std::vector<Capsule>& shapes, double most) {
  std::vector<ClosestVoxel> found(shapes.size());
  run_work([&](Work work) {
    closest(scene, shapes, most, found, work);
    return 0;
  });
  py::dict result;
  result["distance"] = column_of(found, &ClosestVoxel::distance);
  result["voxel"] = column_of(found, &ClosestVoxel::voxel);
  result["point"] = column_of(found, &ClosestVoxel::point);
  result["normal"] = column_of(found, &ClosestVoxel::normal);
  return result;
}

py::object signed_distance_all(const ContactScene& scene, const ArrayLike& points, double most,
                               bool gradient) {
  const Rows places = rows_of<double>(points, "points");
  std::vector<SignedDistance> found(places.size());
  run_work([&](Work work) {
    signed_distance(scene, places, most, found, work);
    return 0;
  });
  py::object distances = column_of(found, &SignedDistance::distance);
  if (!gradient) return distances;
  return py::make_tuple(distances, column_of(found, &SignedDistance::gradient));
}

template <class Shown, class Class>
void define_contacts(Class& shown) {
  const auto none = py::none();
  shown
      .def(
          "overlap",
          [](const Shown& of, const ArrayLike& points, const ArrayLike& radius,
             const std::optional<ArrayLike>& to) {
            return overlap_of(of.contacts(), capsules_of(points, radius, to));
          },
          py::arg("points"), py::arg("radius") = 0.0, py::kw_only(), py::arg("to") = none,
          R"(Tells whether spheres or capsules touch voxels. Returns (N,) bool.

points: (N, 3) real numbers in world units, or one row for all shapes.
radius: a number or (N,).
to: (N, 3) or one row: the other ends of the capsules' cores.)")
      .def(
          "overlap_box",
          [](const Shown& of, const ArrayLike& center, const ArrayLike& half,
             const std::optional<ArrayLike>& turn) {
            return overlap_box(of.contacts(), center, half, turn);
          },
          py::arg("center"), py::arg("half"), py::arg("turn") = none,
          R"(Tells whether boxes touch voxels. Returns (N,) bool.

center, half: (N, 3) real numbers in world units, or one row for all boxes: centres and half sides.
turn: (N, 4) or one row: quaternions (x, y, z, w).)")
      .def(
          "sweep",
          [](const Shown& of, const ArrayLike& points, const ArrayLike& motion,
             const ArrayLike& radius, const std::optional<ArrayLike>& to) {
            return sweep_all(of.contacts(), capsules_of(points, radius, to), motion);
          },
          py::arg("points"), py::arg("motion"), py::arg("radius") = 0.0, py::kw_only(),
          py::arg("to") = none,
          R"(Moves spheres or capsules until they touch a voxel that they approach. Returns a dict.

points, radius, to: as for overlap().
motion: (N, 3) real numbers in world units, or one row for all shapes.
t: (N,) float64, the part of the motion until then, 0 to 1; inf without contact.
voxel: (N, 3) int32; -1 without contact.
point: (N, 3) float64, where the voxel is touched; 0 without contact.
normal: (N, 3) float64 of unit length, from the voxel to the shape; 0 without contact, and if the
shape's core touches the voxel at the start.)")
      .def(
          "closest",
          [](const Shown& of, const ArrayLike& points, const ArrayLike& radius,
             const std::optional<ArrayLike>& to, double most) {
            return closest_all(of.contacts(), capsules_of(points, radius, to), most);
          },
          py::arg("points"), py::arg("radius") = 0.0, py::kw_only(), py::arg("to") = none,
          py::arg("most") = kInfinity,
          R"(Finds the voxels that are closest to points, spheres or capsules. Returns a dict.

points, radius, to: as for overlap().
most: look no farther, in world units.
distance: (N,) float64 from the shape to the voxel, down to -radius where they overlap; inf if no
voxel is in reach.
voxel: (N, 3) int32; -1 if no voxel is in reach.
point: (N, 3) float64, the nearest point of the voxel.
normal: (N, 3) float64 of unit length, from there to the shape's core; 0 if they touch.)")
      .def(
          "signed_distance",
          [](const Shown& of, const ArrayLike& points, double most, bool gradient) {
            return signed_distance_all(of.contacts(), points, most, gradient);
          },
          py::arg("points"), py::kw_only(), py::arg("most") = kInfinity,
          py::arg("gradient") = false,
          R"(Returns the distances from points to the surface, (N,) float64, negative in voxels.

points: (N, 3) real numbers in world units.
most: distances beyond it become most or -most.
gradient: return (distances, gradients), the latter (N, 3) float64: of unit length, away from the
nearest voxel or to the nearest empty place; 0 where there is none.)");
}

}  // namespace

void add_contacts(DagClass& dag) { define_contacts<Dag>(dag); }
void add_contacts(SnapshotClass& snapshot) { define_contacts<Snapshot>(snapshot); }

}  // namespace voxdag::python
