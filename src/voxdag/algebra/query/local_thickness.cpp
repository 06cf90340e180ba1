/// A ball that holds the same centres of voxels as a part of the ball of a neighbour is left out;
/// the others paint their voxels. Source of this test, with tables of radii: G. Borgefors, "Centres
/// of maximal discs in the 5-7-11 distance transform", 1993; E. Remy, E. Thiel, "Exact medial axis
/// with Euclidean distance", 2005.
#include "voxdag/algebra/query/local_thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

/// A ball around place (x, y) of a slice. It holds the centres whose squared distance is at most
/// `reach2`, and its squared diameter is `square`.
struct Ball {
  std::int32_t x, y;
  std::uint32_t square;
  std::int32_t reach2() const { return static_cast<std::int32_t>(square / 4); }
};

/// The largest whole number whose square is at most `square`.
std::int32_t whole_root(std::int32_t square) {
  return static_cast<std::int32_t>(std::sqrt(static_cast<double>(square)));
}

/// Says for each reach2 which reach2 the ball around a neighbour needs to hold the same centres:
/// needed[k - 1][reach2] for a neighbour that differs in k coordinates.
using Needed = std::array<std::vector<std::int32_t>, 3>;

Needed needed_reaches(std::int32_t most) {
  Needed needed;
  for (auto& row : needed) row.assign(static_cast<std::size_t>(most) + 1, 0);
  for (std::int32_t a = 0; a * a <= most; ++a)
    for (std::int32_t b = 0; b <= a && a * a + b * b <= most; ++b)
      for (std::int32_t c = 0; c <= b && a * a + b * b + c * c <= most; ++c) {
        const std::int32_t square = a * a + b * b + c * c;
        const std::int32_t moved[3] = {square + 2 * a + 1, square + 2 * (a + b) + 2,
                                       square + 2 * (a + b + c) + 3};
        for (std::size_t k = 0; k < 3; ++k) {
          std::int32_t& at = needed[k][static_cast<std::size_t>(square)];
          at = std::max(at, moved[k]);
        }
      }
  for (auto& row : needed)
    for (std::size_t i = 1; i < row.size(); ++i) row[i] = std::max(row[i], row[i - 1]);
  return needed;
}

/// The places of a box whose outermost places are empty.
struct Field {
  Vec3i size;
  const CountedVector<std::uint32_t>& squares;

  std::size_t row(std::int32_t y, std::int32_t z) const {
    return static_cast<std::size_t>(size.x) *
           (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
            static_cast<std::size_t>(y));
  }

  /// Returns whether the ball of a place is a part of the ball of a neighbour.
  bool is_redundant(const Needed& needed, std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::uint32_t own = squares[row(y, z) + static_cast<std::size_t>(x)] / 4;
    for (std::int32_t dz = -1; dz <= 1; ++dz)
      for (std::int32_t dy = -1; dy <= 1; ++dy) {
        const std::size_t beside = row(y + dy, z + dz) + static_cast<std::size_t>(x);
        for (std::int32_t dx = -1; dx <= 1; ++dx) {
          const int differ = (dx != 0) + (dy != 0) + (dz != 0);
          if (differ == 0) continue;
          const auto reach =
              static_cast<std::int32_t>(squares[beside + static_cast<std::size_t>(dx + 1) - 1] / 4);
          if (reach >= needed[static_cast<std::size_t>(differ - 1)][own]) return true;
        }
      }
    return false;
  }
};

/// Raises the squares of the places of slice z that lie in a ball of slice `from`.
void paint(const Field& field, const Ball& ball, std::int32_t from, std::int32_t z,
           CountedVector<std::uint32_t>& result) {
  const std::int32_t left = ball.reach2() - (z - from) * (z - from);
  if (left < 0) return;
  const std::int32_t high = whole_root(left);
  for (std::int32_t dy = -high; dy <= high; ++dy) {
    const std::int32_t wide = whole_root(left - dy * dy);
    std::uint32_t* const row = result.data() + field.row(ball.y + dy, z);
    for (std::int32_t x = ball.x - wide; x <= ball.x + wide; ++x)
      row[x] = std::max(row[x], ball.square);
  }
}

}  // namespace

LocalThickness local_thickness(const SvdagView& dag, Work work) {
  LocalThickness result{bounds_of(dag, work), CountedVector<std::uint32_t>(work.memory)};
  if (dag.is_empty()) return result;
  result.box.lo = result.box.lo - Vec3i{1, 1, 1};
  result.box.hi = result.box.hi + Vec3i{1, 1, 1};
  const CountedVector<std::uint32_t> squares = depth_squares(dag, result.box, work);
  const Field field{result.box.hi - result.box.lo, squares};
  const std::int32_t most =
      static_cast<std::int32_t>(*std::max_element(squares.begin(), squares.end()) / 4);
  const Needed needed = needed_reaches(most);

  const auto slices = static_cast<std::size_t>(field.size.z);
  std::vector<CountedVector<Ball>> balls(slices, CountedVector<Ball>(work.memory));
  polled_for(slices, 1, work, "balls", [&](std::size_t slice) {
    const auto z = static_cast<std::int32_t>(slice);
    for (std::int32_t y = 0; y < field.size.y; ++y)
      for (std::int32_t x = 0; x < field.size.x; ++x) {
        const std::uint32_t square = squares[field.row(y, z) + static_cast<std::size_t>(x)];
        if (square != 0 && !field.is_redundant(needed, x, y, z))
          balls[slice].push_back({x, y, square});
      }
  });

  result.squares.resize(squares.size());
  const std::int32_t reach = whole_root(most);
  polled_for(slices, 1, work, "thickness", [&](std::size_t slice) {
    const auto z = static_cast<std::int32_t>(slice);
    const std::int32_t last = std::min(z + reach, field.size.z - 1);
    for (std::int32_t from = std::max(z - reach, 0); from <= last; ++from)
      for (const Ball& ball : balls[static_cast<std::size_t>(from)])
        paint(field, ball, from, z, result.squares);
  });
  return result;
}

}  // namespace voxdag
