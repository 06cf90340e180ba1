#include "voxdag/algebra/query/distance_field.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

enum class Target { kVoxels, kEmptyPlaces };

/// Four times a squared distance in voxels: a whole number.
using Squares = CountedVector<std::uint32_t>;
constexpr std::uint32_t kNone = kNoSquare;

/// Returns four times the squared distance along an axis from the centre of a place to the cube of
/// the place `steps` farther.
std::int64_t axis_square(std::int64_t steps) {
  const std::int64_t doubled = 2 * std::abs(steps) - 1;
  return steps == 0 ? 0 : doubled * doubled;
}

/// Returns whether every distance in a box of this size fits into Squares.
bool fits(Vec3i size) {
  return axis_square(size.x) + axis_square(size.y) + axis_square(size.z) < kNone;
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// A line of places. Each holds the least square to a target across the line.
class Line {
 public:
  explicit Line(std::size_t places) : square_(places), site_(places), first_(places) {}

  std::uint32_t& operator[](std::size_t place) { return square_[place]; }

  /// Adds the squares along the line: calls result(place, least square) for all places.
  template <class Result>
  void transform(const Result& result) {
    const auto places = static_cast<std::int64_t>(square_.size());
    std::size_t count = 0;  // Of the sites that are nearest to some place before this one.
    for (std::int64_t site = 0; site < places; ++site) {
      if (at(site) == kNone) continue;
      while (count > 0 && sum(site, first_[count - 1]) < sum(site_[count - 1], first_[count - 1]))
        --count;
      const std::int64_t first = count == 0 ? 0 : first_nearer(site_[count - 1], site);
      if (first >= places) continue;
      site_[count] = site;
      first_[count++] = first;
    }
    for (std::int64_t place = places - 1; place >= 0; --place) {
      if (count == 0) {
        result(static_cast<std::size_t>(place), kNone);
        continue;
      }
      result(static_cast<std::size_t>(place),
             static_cast<std::uint32_t>(sum(site_[count - 1], place)));
      if (place == first_[count - 1]) --count;
    }
  }

 private:
  std::int64_t at(std::int64_t place) const { return square_[static_cast<std::size_t>(place)]; }
  std::int64_t sum(std::int64_t site, std::int64_t place) const {
    return at(site) + axis_square(place - site);
  }

  /// Returns the first place that is nearer to site `b` than to site `a` < b. The difference of the
  /// sums grows along the line, linearly before a, between a and b, and after b.
  std::int64_t first_nearer(std::int64_t a, std::int64_t b) const {
    const std::int64_t lead = at(a) - at(b), apart = b - a, near = axis_square(apart);
    const auto first = [&](std::int64_t slope, std::int64_t middle) {
      return floor_divide(slope * middle - lead, 2 * slope) + 1;
    };
    if (lead > near) return std::min(first(4 * apart, a + b - 1), a);
    if (lead <= -near) return std::max(first(4 * apart, a + b + 1), b + 1);
    if (apart == 1) return b;
    return std::clamp(first(4 * (apart - 1), a + b), a + 1, b);
  }

  std::vector<std::uint32_t> square_;
  std::vector<std::int64_t> site_;   ///< Sites that are nearest to a run of places, in order.
  std::vector<std::int64_t> first_;  ///< The first place of each run.
};

/// The places of a box.
struct Places {
  Box3i box;
  Vec3i size = box.hi - box.lo;
  std::size_t row = static_cast<std::size_t>(size.x);
  std::size_t slice = row * static_cast<std::size_t>(size.y);
  std::size_t count = slice * static_cast<std::size_t>(size.z);
};

/// Sets the squares of the targets to 0, and those of the other places to kNone.
void mark(const SvdagView& dag, const Places& places, Target target, Work work, Squares& squares) {
  constexpr std::int32_t kThick = 16;
  const std::uint32_t at_voxel = target == Target::kVoxels ? 0 : kNone;
  polled_for(static_cast<std::size_t>((places.size.z + kThick - 1) / kThick), 1, work, "distances",
             [&](std::size_t slab) {
               Box3i part = places.box;
               part.lo.z += static_cast<std::int32_t>(slab) * kThick;
               part.hi.z = std::min(part.hi.z, part.lo.z + kThick);
               const auto offset = [&](Vec3i place) {
                 const Vec3i p = place - places.box.lo;
                 return static_cast<std::size_t>(p.z) * places.slice +
                        static_cast<std::size_t>(p.y) * places.row + static_cast<std::size_t>(p.x);
               };
               std::fill(squares.begin() + static_cast<std::ptrdiff_t>(offset(part.lo)),
                         squares.begin() +
                             static_cast<std::ptrdiff_t>(offset({part.lo.x, part.lo.y, part.hi.z})),
                         target == Target::kVoxels ? kNone : 0);
               if (!dag.is_empty())
                 for_each_voxel(dag, part, [&](Vec3i voxel) { squares[offset(voxel)] = at_voxel; });
             });
}

/// Transforms the lines of an axis, whose places are `step` apart in the arrays. Lines that are
/// neighbours in memory are copied together. `result` gets the index in the arrays.
template <class Result>
void transform_lines(Squares& squares, std::size_t length, std::size_t step, Work work,
                     const Result& result) {
  constexpr std::size_t kTogether = 16;  // A line of the cache.
  const std::size_t blocks = (step + kTogether - 1) / kTogether;
  const std::size_t groups = squares.size() / (length * step);
  polled_for(groups * blocks, 1, work, "distances", [&](std::size_t i) {
    const std::size_t begin = i % blocks * kTogether, end = std::min(begin + kTogether, step);
    const std::size_t base = i / blocks * length * step;
    std::vector<Line> lines(end - begin, Line(length));
    for (std::size_t place = 0; place < length; ++place)
      for (std::size_t l = begin; l < end; ++l)
        lines[l - begin][place] = squares[base + place * step + l];
    for (std::size_t l = begin; l < end; ++l)
      lines[l - begin].transform([&](std::size_t place, std::uint32_t square) {
        result(base + place * step + l, square);
      });
  });
}

/// Returns the squares to the targets in the box, which must fit; kNone if there are none.
Squares squares_within(const SvdagView& dag, const Places& places, Target target, Work work) {
  Squares squares(work.memory);
  squares.resize(places.count);
  mark(dag, places, target, work, squares);
  const auto store = [&](std::size_t i, std::uint32_t square) { squares[i] = square; };
  transform_lines(squares, places.row, 1, work, store);
  transform_lines(squares, static_cast<std::size_t>(places.size.y), places.row, work, store);
  transform_lines(squares, static_cast<std::size_t>(places.size.z), places.slice, work, store);
  return squares;
}

/// Returns the distances to the targets in the box; infinity if there are none or if the squares do
/// not fit.
std::vector<float> distances_within(const SvdagView& dag, const Places& places, Target target,
                                    Work work) {
  std::vector<float> distances(places.count, HUGE_VALF);
  if (!fits(places.size)) return distances;
  const Squares squares = squares_within(dag, places, target, work);
  polled_for(places.count / places.row, 64, work, "distances", [&](std::size_t row) {
    for (std::size_t i = row * places.row; i < (row + 1) * places.row; ++i)
      if (squares[i] != kNone)
        distances[i] = static_cast<float>(std::sqrt(static_cast<double>(squares[i])) / 2);
  });
  return distances;
}

/// Returns the distance from the centre of a place in the box to the nearest place outside of it.
double distance_to_outside(const Box3i& box, Vec3i place) {
  std::int32_t steps = std::numeric_limits<std::int32_t>::max();
  for (int axis = 0; axis < 3; ++axis)
    steps = std::min({steps, place[axis] - box.lo[axis], box.hi[axis] - 1 - place[axis]});
  return steps + 0.5;
}

/// Calls body(place, index) for all places, in parallel by rows.
template <class Body>
void for_each_place(const Places& places, Work work, const Body& body) {
  polled_for(places.count / places.row, 1, work, "distances", [&](std::size_t i) {
    const auto y = static_cast<std::int32_t>(i % static_cast<std::size_t>(places.size.y));
    const auto z = static_cast<std::int32_t>(i / static_cast<std::size_t>(places.size.y));
    for (std::int32_t x = 0; x < places.size.x; ++x)
      body(places.box.lo + Vec3i{x, y, z}, i * places.row + static_cast<std::size_t>(x));
  });
}

/// Returns the box with `steps` more places on each side, without those that are outside of the
/// grid and not next to it.
Box3i grown(const Box3i& box, std::int32_t steps, std::int32_t grid_side) {
  Box3i result;
  for (int axis = 0; axis < 3; ++axis) {
    result.lo[axis] = std::min(box.lo[axis], std::max(box.lo[axis] - steps, -1));
    result.hi[axis] = std::max(box.hi[axis], std::min(box.hi[axis] + steps, grid_side + 1));
  }
  return result;
}

}  // namespace

CountedVector<std::uint32_t> depth_squares(const SvdagView& dag, const Box3i& box, Work work) {
  const Places places{box};
  if (!fits(places.size))
    throw Error("the voxels reach too far for depths: the diagonal of their box is at most 32,767");
  return squares_within(dag, places, Target::kEmptyPlaces, work);
}

std::vector<float> distance_field(const SvdagView& dag, const Box3i& box, Work work) {
  const Places places{box};
  std::vector<float> distances = distances_within(dag, places, Target::kVoxels, work);
  const std::int32_t side = std::int32_t{1} << dag.levels;
  const bool holds_grid = std::max({box.lo.x, box.lo.y, box.lo.z}) <= 0 &&
                          std::min({box.hi.x, box.hi.y, box.hi.z}) >= side;
  if (dag.is_empty() || (holds_grid && fits(places.size))) return distances;
  // Places that may be nearer to a voxel outside of the box.
  for_each_place(places, work, [&](Vec3i place, std::size_t i) {
    double most = distances[i];
    if (most <= distance_to_outside(box, place)) return;
    // The place before is one voxel away at most; the rest is for rounding.
    if (place.x > box.lo.x)
      most = std::min(most, (static_cast<double>(distances[i - 1]) + 1) * (1 + 1e-6));
    const auto nearest =
        nearest_voxel(dag, static_cast<Vec3d>(place) + Vec3d{0.5, 0.5, 0.5}, most * most);
    if (nearest) distances[i] = static_cast<float>(std::sqrt(nearest->distance2));
  });
  return distances;
}

std::vector<float> signed_distance_field(const SvdagView& dag, const Box3i& box, Work work) {
  const Places places{box};
  std::vector<float> distances = distance_field(dag, box, work);
  const std::int32_t side = std::int32_t{1} << dag.levels;
  for (std::int32_t steps = 1;; steps *= 2) {
    const Places around{grown(box, steps, side)};
    if (!fits(around.size))
      throw Error("the window is too long for signed distances: its diagonal is at most 32,767");
    const MemoryReservation field(work.memory, around.count * sizeof(float));
    const std::vector<float> depths = distances_within(dag, around, Target::kEmptyPlaces, work);
    const bool is_all = grown(box, 2 * steps, side) == around.box;
    std::atomic<bool> is_done{true};
    std::vector<float> result = distances;
    for_each_place(places, work, [&](Vec3i place, std::size_t i) {
      if (distances[i] > 0) return;
      const Vec3i p = place - around.box.lo;
      const float depth =
          depths[static_cast<std::size_t>(p.z) * around.slice +
                 static_cast<std::size_t>(p.y) * around.row + static_cast<std::size_t>(p.x)];
      if (!is_all && !(depth <= distance_to_outside(around.box, place)))
        is_done.store(false, std::memory_order_relaxed);
      result[i] = -depth;
    });
    if (is_done) return result;
  }
}

}  // namespace voxdag
