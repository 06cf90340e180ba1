#pragma once
/// A palette: few colours that stand for many.
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// The colours of a palette (sRGB encoded), and a map from colours to them.
class ColorPalette {
 public:
  const std::vector<Value8>& colors() const { return colors_; }
  /// Returns the index of the colour that stands for `color`, which was counted.
  std::uint8_t index_of(Value8 color) const;

 private:
  friend class ColorCounter;
  std::vector<Value8> colors_;
  /// The indices of all colours if they fit into the palette; `cells_` is then empty.
  std::unordered_map<std::uint32_t, std::uint8_t> exact_;
  std::vector<std::uint8_t> cells_;
};

/// Counts colours, and chooses a palette for them.
/// Source: Wu, "Efficient Statistical Computations for Optimal Color Quantization", Graphics Gems
/// II, 1991: cuts the colour cube, in 64³ cells, where it most reduces the sum of squared errors.
class ColorCounter {
 public:
  /// The palette may have up to `most` colours, 1 to 255.
  explicit ColorCounter(int most);

  void add(Value8 color);
  /// Returns the colours themselves if they are few enough, in the order of their codes.
  ColorPalette palette() const;

 private:
  struct Cell {
    std::int64_t count = 0, x = 0, y = 0, z = 0, squares = 0;
  };
  std::size_t most_;
  std::unordered_set<std::uint32_t> exact_;  ///< The colours; empty if there are too many.
  bool is_exact_ = true;
  std::vector<Cell> cells_;
};

}  // namespace voxdag
