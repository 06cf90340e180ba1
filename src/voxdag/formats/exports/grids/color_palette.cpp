#include "voxdag/formats/exports/grids/color_palette.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace voxdag {
namespace {

constexpr int kSide = 64, kShift = 2;

std::uint32_t code_of(Value8 color) {
  return std::uint32_t{color.x} << 16 | std::uint32_t{color.y} << 8 | color.z;
}
Value8 color_of(std::uint32_t code) {
  return {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8),
          static_cast<std::uint8_t>(code)};
}
std::size_t cell_of(Value8 color) {
  return (static_cast<std::size_t>(color.x >> kShift) * kSide + (color.y >> kShift)) * kSide +
         (color.z >> kShift);
}

/// Sums over the colours of cells.
struct Moments {
  std::int64_t count = 0, x = 0, y = 0, z = 0, squares = 0;

  Moments& add(const Moments& other, int sign) {
    count += sign * other.count;
    x += sign * other.x;
    y += sign * other.y;
    z += sign * other.z;
    squares += sign * other.squares;
    return *this;
  }
  /// Returns the squared length of the sum of colours by their number.
  double gain() const {
    if (count == 0) return 0;
    const auto dx = static_cast<double>(x), dy = static_cast<double>(y),
               dz = static_cast<double>(z);
    return (dx * dx + dy * dy + dz * dz) / static_cast<double>(count);
  }
  /// Returns the sum of squared distances to the mean.
  double error() const { return static_cast<double>(squares) - gain(); }
  Value8 mean() const {
    const auto rounded = [this](std::int64_t sum) {
      return static_cast<std::uint8_t>((2 * sum + count) / (2 * count));
    };
    return {rounded(x), rounded(y), rounded(z)};
  }
};

/// A half-open box of cells.
struct CellBox {
  std::array<int, 3> lo{0, 0, 0}, hi{kSide, kSide, kSide};
};

/// Sums over all cells below a corner.
class SummedCells {
 public:
  template <class Cell>
  explicit SummedCells(const std::vector<Cell>& cells) : sums_(kStep * kStep * kStep) {
    for (int x = 1; x <= kSide; ++x)
      for (int y = 1; y <= kSide; ++y)
        for (int z = 1; z <= kSide; ++z) {
          const Cell& cell = cells[((x - 1) * kSide + y - 1) * kSide + z - 1];
          Moments& sum = at(x, y, z);
          sum = {cell.count, cell.x, cell.y, cell.z, cell.squares};
          sum.add(at(x - 1, y, z), 1).add(at(x, y - 1, z), 1).add(at(x, y, z - 1), 1);
          sum.add(at(x - 1, y - 1, z), -1)
              .add(at(x - 1, y, z - 1), -1)
              .add(at(x, y - 1, z - 1), -1);
          sum.add(at(x - 1, y - 1, z - 1), 1);
        }
  }
  Moments of(const CellBox& box) const {
    Moments sum;
    for (int corner = 0; corner < 8; ++corner) {
      const auto coordinate = [&](int axis) {
        const auto a = static_cast<std::size_t>(axis);
        return (corner >> axis & 1) != 0 ? box.lo[a] : box.hi[a];
      };
      const int lows = (corner & 1) + (corner >> 1 & 1) + (corner >> 2);
      sum.add(at(coordinate(0), coordinate(1), coordinate(2)), lows % 2 == 0 ? 1 : -1);
    }
    return sum;
  }

 private:
  static constexpr int kStep = kSide + 1;
  const Moments& at(int x, int y, int z) const { return sums_[(x * kStep + y) * kStep + z]; }
  Moments& at(int x, int y, int z) { return sums_[(x * kStep + y) * kStep + z]; }
  std::vector<Moments> sums_;
};

/// Cuts the box in two where that most reduces the error. Returns whether it can be cut.
bool cut(const SummedCells& sums, CellBox& box, CellBox& other) {
  const Moments whole = sums.of(box);
  double best = whole.gain();
  std::optional<std::pair<std::size_t, int>> place;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int at = box.lo[axis] + 1; at < box.hi[axis]; ++at) {
      CellBox low = box;
      low.hi[axis] = at;
      const Moments lows = sums.of(low);
      Moments highs = whole;
      highs.add(lows, -1);
      if (lows.count == 0 || highs.count == 0) continue;
      if (const double gain = lows.gain() + highs.gain(); !place || gain > best) {
        best = gain;
        place = {axis, at};
      }
    }
  if (!place) return false;
  other = box;
  box.hi[place->first] = other.lo[place->first] = place->second;
  return true;
}

}  // namespace

ColorCounter::ColorCounter(int most)
    : most_(static_cast<std::size_t>(most)), cells_(kSide * kSide * kSide) {}

void ColorCounter::add(Value8 color) {
  if (is_exact_) {
    exact_.insert(code_of(color));
    is_exact_ = exact_.size() <= most_;
    if (!is_exact_) exact_.clear();
  }
  Cell& cell = cells_[cell_of(color)];
  ++cell.count;
  cell.x += color.x;
  cell.y += color.y;
  cell.z += color.z;
  cell.squares += color.x * color.x + color.y * color.y + color.z * color.z;
}

ColorPalette ColorCounter::palette() const {
  ColorPalette palette;
  if (is_exact_) {
    std::vector<std::uint32_t> codes(exact_.begin(), exact_.end());
    std::sort(codes.begin(), codes.end());
    for (const std::uint32_t code : codes) {
      palette.exact_[code] = static_cast<std::uint8_t>(palette.colors_.size());
      palette.colors_.push_back(color_of(code));
    }
    return palette;
  }
  const SummedCells sums(cells_);
  std::vector<CellBox> boxes(1);
  std::vector<double> errors{sums.of(boxes[0]).error()};
  while (boxes.size() < most_) {
    const auto worst =
        static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
    if (errors[worst] <= 0) break;
    CellBox other;
    if (cut(sums, boxes[worst], other)) {
      errors[worst] = sums.of(boxes[worst]).error();
      errors.push_back(sums.of(other).error());
      boxes.push_back(other);
    } else {
      errors[worst] = 0;  // the colours of one cell
    }
  }
  palette.cells_.resize(cells_.size());
  for (const CellBox& box : boxes) {
    const auto index = static_cast<std::uint8_t>(palette.colors_.size());
    palette.colors_.push_back(sums.of(box).mean());
    for (int x = box.lo[0]; x < box.hi[0]; ++x)
      for (int y = box.lo[1]; y < box.hi[1]; ++y)
        for (int z = box.lo[2]; z < box.hi[2]; ++z)
          palette.cells_[(x * kSide + y) * kSide + z] = index;
  }
  return palette;
}

std::uint8_t ColorPalette::index_of(Value8 color) const {
  return cells_.empty() ? exact_.at(code_of(color)) : cells_[cell_of(color)];
}

}  // namespace voxdag
