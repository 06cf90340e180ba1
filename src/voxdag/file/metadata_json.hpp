#pragma once
/// Reads and writes the JSON of metadata: values whose errors name their place, and the members
/// that all scene files have.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/scene_metadata.hpp"

namespace voxdag {

using MetadataJson = nlohmann::ordered_json;

/// A value of the document with the path to it, which errors name.
struct MetadataField {
  const MetadataJson& value;
  std::string path;

  [[noreturn]] void fail(const std::string& reason) const { throw Error("", path, reason); }

  MetadataField at(const std::string& key) const {
    const std::string child = path.empty() ? key : path + "." + key;
    if (!value.is_object()) fail("not an object");
    const auto it = value.find(key);
    if (it == value.end()) throw Error("", child, "missing");
    return {*it, child};
  }
  MetadataField at(std::size_t index) const {
    return {value[index], path + "[" + std::to_string(index) + "]"};
  }

  void expect_array(std::size_t size) const {
    if (!value.is_array() || value.size() != size)
      fail("not an array of " + std::to_string(size) + " values");
  }
  std::uint64_t count() const {
    if (!value.is_number_unsigned()) fail("not a whole number of 0 or more");
    return value.get<std::uint64_t>();
  }
  /// From -2^53 to 2^53.
  std::int64_t integer() const {
    constexpr std::int64_t kMost = std::int64_t{1} << 53;
    if (!value.is_number_integer()) fail("not a whole number");
    if (value.get<double>() < -0x1p53 || value.get<double>() > 0x1p53 ||
        std::abs(value.get<std::int64_t>()) > kMost)
      fail("not from -2^53 to 2^53");
    return value.get<std::int64_t>();
  }
  double finite() const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) fail("not a finite number");
    return value.get<double>();
  }
  double positive() const {
    if (!(finite() > 0)) fail("not positive");
    return value.get<double>();
  }
  std::string text() const {
    if (!value.is_string()) fail("not a string");
    return value.get<std::string>();
  }
  /// Returns the values of an array of `size` counts.
  std::vector<std::uint64_t> counts(std::size_t size) const {
    expect_array(size);
    std::vector<std::uint64_t> values(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = at(i).count();
    return values;
  }
};

/// Parses the text. Throws Error with the byte at which it is not valid JSON.
MetadataJson parse_metadata_json(std::string_view text);

std::string metadata_text(const MetadataJson& json);

/// Begins the document, with "grid".
MetadataJson begin_metadata_json(const SceneMetadata& metadata);
/// Adds "source", "program" and "build", and the presentation: the last members of the document.
void finish_metadata_json(MetadataJson& json, const SceneMetadata& metadata);

/// Adds "up", "unit", "home" and "cubes", as far as they are known.
void add_presentation(MetadataJson& json, const Presentation& presentation);

/// Reads "grid", "source", "program", "build" and the presentation from the document's root.
void read_scene_metadata(const MetadataField& root, SceneMetadata& metadata);

}  // namespace voxdag
