#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "dag.hpp"
#include "voxdag/formats/imports/points/color_range.hpp"

namespace py = pybind11;

namespace voxdag::python {
namespace {

[[noreturn]] void refuse(const char* name, const std::string& value, const std::string& allowed) {
  throw py::value_error(std::string(name) + " has " + value + ", which must be " + allowed);
}

std::string text_of(double value) { return py::cast<std::string>(py::str(py::float_(value))); }

constexpr const char* kWholeNumbers = "whole numbers";

/// Calls store(i, value) for the values of an array of this kind, in C order. Refuses those that
/// are not whole or not in range; also NaN.
template <class Store>
void take_whole(const py::array& given, char kind, const char* name, std::int64_t least,
                std::int64_t most, const Store& store) {
  const std::string range =
      "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const auto take = [&](const auto& values) {
    for (py::ssize_t i = 0; i < values.size(); ++i) {
      const auto value = values.data()[i];
      if constexpr (std::is_floating_point_v<std::remove_cv_t<decltype(value)>>) {
        if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most) &&
              value == std::floor(value)))
          refuse(name, text_of(value), range);
      } else if (std::cmp_less(value, least) || std::cmp_greater(value, most)) {
        refuse(name, std::to_string(value), range);
      }
      store(static_cast<std::size_t>(i), static_cast<std::int64_t>(value));
    }
  };
  if (kind == 'f')
    take(Array<double>(given));
  else if (kind == 'u')
    take(Array<std::uint64_t>(given));
  else
    take(Array<std::int64_t>(given));
}

}  // namespace

char kind_of(const py::array& array, const char* name, std::string_view allowed,
             const char* allowed_in_words) {
  const char kind = array.dtype().kind();
  if (allowed.find(kind) == std::string_view::npos)
    throw py::type_error(std::string(name) + " has the type " +
                         py::cast<std::string>(py::str(array.dtype())) + ", and must be " +
                         allowed_in_words);
  return kind;
}

void check_rows(const py::array& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw py::value_error(std::string(name) + " must have the shape (N, 3)");
}

std::vector<Vec3<std::int64_t>> whole_rows_of(const py::array& given, const char* name,
                                              std::int64_t least, std::int64_t most) {
  const char kind = kind_of(given, name, "iuf", kWholeNumbers);
  check_rows(given, name);
  std::vector<Vec3<std::int64_t>> rows(static_cast<std::size_t>(given.shape(0)));
  take_whole(given, kind, name, least, most, [&](std::size_t i, std::int64_t value) {
    rows[i / 3][static_cast<int>(i % 3)] = value;
  });
  return rows;
}

std::vector<std::int64_t> whole_values_of(const py::array& given, const char* name,
                                          std::int64_t least, std::int64_t most) {
  const char kind = kind_of(given, name, "iuf", kWholeNumbers);
  if (given.ndim() != 1) throw py::value_error(std::string(name) + " must have the shape (N,)");
  std::vector<std::int64_t> values(static_cast<std::size_t>(given.shape(0)));
  take_whole(given, kind, name, least, most,
             [&](std::size_t i, std::int64_t value) { values[i] = value; });
  return values;
}

std::vector<Vec3i> voxels_of(const py::array& given, const char* name) {
  using Limits = std::numeric_limits<std::int32_t>;
  std::vector<Vec3i> voxels;
  for (const Vec3<std::int64_t> row : whole_rows_of(given, name, Limits::min(), Limits::max()))
    voxels.push_back(Vec3i(row));
  return voxels;
}

std::vector<Vec3<std::uint8_t>> colors_of(const py::array& given) {
  constexpr const char* kName = "colors";
  const char kind = kind_of(given, kName, "iuf", "numbers");
  const bool is_16_bits = kind == 'u' && given.itemsize() == 2;
  std::vector<Vec3<std::uint8_t>> colors;
  if (kind != 'f') {
    const auto rows = whole_rows_of(given, kName, 0, is_16_bits ? 65535 : 255);
    std::int64_t greatest = 0;
    for (const Vec3<std::int64_t> row : rows) greatest = std::max({greatest, row.x, row.y, row.z});
    std::vector<std::string> warnings;
    const bool is_wide =
        is_16_bits && color_range(false, static_cast<double>(greatest), warnings) == 65535;
    for (const std::string& warning : warnings) warn("colors: " + warning);
    for (const Vec3<std::int64_t> row : rows) {
      Vec3<std::uint8_t> color;
      for (int c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(is_wide ? (row[c] + 128) / 257 : row[c]);
      colors.push_back(color);
    }
    return colors;
  }
  // Sums of float32 may exceed 1 by their rounding.
  constexpr double kRounding = 1e-6;
  for (const Vec3d row : rows_of<double>(given, kName)) {
    Vec3<std::uint8_t> color;
    for (int c = 0; c < 3; ++c) {
      if (!(row[c] >= -kRounding && row[c] <= 1 + kRounding))
        refuse(kName, text_of(row[c]), "from 0 to 1 if the colours are real numbers");
      color[c] = static_cast<std::uint8_t>(std::nearbyint(std::clamp(row[c], 0.0, 1.0) * 255));
    }
    colors.push_back(color);
  }
  return colors;
}

}  // namespace voxdag::python
