#include "cli/parse.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "voxdag/core/grid.hpp"

namespace voxdag::cli {
namespace {

constexpr int kMaxImageSide = 1 << 15;

/// Returns the value of a text that is a finite number, else nothing.
template <class T>
std::optional<T> number_of(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool good = error == std::errc() && end == text.data() + text.size() && !text.empty();
  if constexpr (std::is_floating_point_v<T>) good = good && std::isfinite(value);
  return good ? std::optional(value) : std::nullopt;
}

/// Returns the value of a text that is a finite number. Else throws "... is not EXPECTED".
template <class T>
T parse_number(std::string_view text, const char* expected) {
  const std::optional<T> value = number_of<T>(text);
  if (!value) throw std::invalid_argument(fmt::format("\"{}\" is not {}", text, expected));
  return *value;
}

/// Parses an element of a list: a whole number, or a number in the range of float.
template <class T>
T parse_element(std::string_view text) {
  if constexpr (std::is_integral_v<T>) {
    return parse_number<T>(text, "a whole number");
  } else {
    const T value = parse_number<T>(text, "a number");
    if (std::fabs(value) > std::numeric_limits<float>::max())
      throw std::invalid_argument(fmt::format("\"{}\" is too large", text));
    return value;
  }
}

template <class T, std::size_t N>
std::array<T, N> parse_list(std::string_view text) {
  std::array<T, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == N))
      throw std::invalid_argument(fmt::format("must be {} numbers separated by commas", N));
    values[i] = parse_element<T>(text.substr(0, comma));
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return values;
}

template <class T>
Box<T> parse_box_of(const std::string& text) {
  const auto v = parse_list<T, 6>(text);
  const Box<T> box{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.lo[axis] < box.hi[axis]))
      throw std::invalid_argument(
          "each coordinate of the second corner must be greater than that of the first");
  return box;
}

}  // namespace

std::optional<double> read_number(std::string_view text) { return number_of<double>(text); }

std::optional<std::int64_t> read_whole_number(std::string_view text) {
  return number_of<std::int64_t>(text);
}

std::vector<double> parse_numbers(const std::string& text) {
  std::vector<double> values;
  std::string_view rest = text;
  for (;;) {
    const std::size_t comma = rest.find(',');
    values.push_back(parse_element<double>(rest.substr(0, comma)));
    if (comma == std::string_view::npos) return values;
    rest.remove_prefix(comma + 1);
  }
}

std::vector<std::string> parse_words(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  std::erase(words, "");
  if (words.empty()) throw std::invalid_argument("must be words between commas");
  return words;
}

Vec3d parse_vec3(const std::string& text) {
  const auto v = parse_list<double, 3>(text);
  return {v[0], v[1], v[2]};
}

Vec3d parse_direction(const std::string& text) {
  const Vec3d direction = parse_vec3(text);
  if (!(dot(direction, direction) > 0))
    throw std::invalid_argument(fmt::format("\"{}\" is not a direction: its length is zero", text));
  return direction;
}

Vec3<std::uint8_t> parse_color(const std::string& text) {
  const Vec3d channels = parse_vec3(text);
  Vec3<std::uint8_t> color{};
  for (int c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(std::clamp(channels[c], 0.0, 255.0));
    if (color[c] != channels[c])
      throw std::invalid_argument("must be three whole numbers from 0 to 255");
  }
  return color;
}

Box3d parse_box(const std::string& text) { return parse_box_of<double>(text); }

Box3i parse_window(const std::string& text) { return parse_box_of<std::int32_t>(text); }

int parse_axis(const std::string& text) {
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z')
    throw std::invalid_argument("must be x, y or z");
  return text[0] - 'x';
}

double parse_finite(const std::string& text) { return parse_number<double>(text, "a number"); }

double parse_positive(const std::string& text) {
  const double value = parse_number<double>(text, "a number");
  if (!(value > 0)) throw std::invalid_argument("must be greater than zero");
  return value;
}

std::int64_t parse_resolution(const std::string& text) {
  constexpr std::int64_t kMax = std::int64_t{1} << kMaxLevels;
  const bool kilo = text.ends_with('K') || text.ends_with('k');
  const auto n = read_whole_number(std::string_view(text).substr(0, text.size() - (kilo ? 1 : 0)));
  if (!n || *n < 1 || *n > (kilo ? kMax / 1024 : kMax))
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a whole number from 1 to {}", text, kMax));
  return kilo ? *n * 1024 : *n;
}

int parse_levels(const std::string& text) {
  constexpr std::uint64_t kMin = 1u << kMinLevels, kMax = 1u << kMaxLevels;
  const bool kilo = text.ends_with('K') || text.ends_with('k');
  std::uint64_t n = parse_number<std::uint64_t>(
      std::string_view(text).substr(0, text.size() - (kilo ? 1 : 0)), "a whole number");
  if (kilo) n = n <= kMax ? n * 1024 : kMax + 1;
  if (n < kMin || n > kMax)
    throw std::invalid_argument(
        fmt::format("{} is not a power of two from {} to {}; the nearest is {}", text, kMin, kMax,
                    n < kMin ? kMin : kMax));
  if (!std::has_single_bit(n))
    throw std::invalid_argument(
        fmt::format("{} is not a power of two from {} to {}; the nearest are {} and {}", text, kMin,
                    kMax, std::bit_floor(n), std::bit_ceil(n)));
  return std::countr_zero(n);
}

std::uint64_t parse_memory(const std::string& text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const double value = parse_number<double>(std::string_view(text).substr(0, digits),
                                            "an amount of memory such as 512M or 16GiB");
  std::string unit = text.substr(digits);
  for (const char* ending : {"iB", "B"})
    if (unit.ends_with(ending)) {
      unit.resize(unit.size() - std::string_view(ending).size());
      break;
    }
  static constexpr std::string_view kUnits = "KMGT";
  double factor = 1;
  if (!unit.empty()) {
    const std::size_t power = kUnits.find(static_cast<char>(unit[0] & ~0x20));
    if (unit.size() != 1 || power == std::string_view::npos)
      throw std::invalid_argument(
          fmt::format("\"{}\" has an unknown unit: the units are K, M, G and T", text));
    factor = std::exp2(10.0 * static_cast<double>(power + 1));
  }
  constexpr double kFewBytes = 65536;  // less than any program takes
  if (unit.empty() && text.find('B') == text.npos && value > 0 && value < kFewBytes)
    throw std::invalid_argument(
        fmt::format("\"{0}\" is a number of bytes: give a unit, such as {0}M", text));
  const double bytes = value * factor;
  if (!(bytes >= 1 && bytes < 0x1p63)) throw std::invalid_argument("must be at least one byte");
  return static_cast<std::uint64_t>(bytes);
}

ImageSize parse_image_size(const std::string& text) {
  const std::size_t x = text.find('x');
  if (x == std::string::npos)
    throw std::invalid_argument("must be WIDTHxHEIGHT, such as 1920x1080");
  const std::string_view view = text;
  const ImageSize size{parse_number<int>(view.substr(0, x), "a width in pixels"),
                       parse_number<int>(view.substr(x + 1), "a height in pixels")};
  for (const int side : {size.width, size.height})
    if (side < 1 || side > kMaxImageSide)
      throw std::invalid_argument(fmt::format("each side must be 1 to {} pixels", kMaxImageSide));
  return size;
}

}  // namespace voxdag::cli
