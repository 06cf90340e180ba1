#include "voxdag/file/vdag_metadata.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::ordered_json;

/// One value of the document with the path to it, for errors that say where.
struct Field {
  const Json& value;
  std::string path;

  [[noreturn]] void fail(const std::string& reason) const { throw Error("", path, reason); }

  Field at(const std::string& key) const {
    const std::string child = path.empty() ? key : path + "." + key;
    if (!value.is_object()) fail("not an object");
    const auto it = value.find(key);
    if (it == value.end()) throw Error("", child, "missing");
    return {*it, child};
  }
  Field at(std::size_t index) const {
    return {value[index], path + "[" + std::to_string(index) + "]"};
  }

  void expect_array(std::size_t size) const {
    if (!value.is_array() || value.size() != size)
      fail("not an array of " + std::to_string(size) + " values");
  }
  std::uint64_t count() const {
    if (!value.is_number_unsigned()) fail("not a count");
    return value.get<std::uint64_t>();
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
};

Grid read_grid(const Field& field) {
  Grid grid;
  const std::uint64_t levels = field.at("levels").count();
  if (levels < kMinLevels || levels > kMaxLevels)
    field.at("levels").fail(std::to_string(levels) + " is not " + std::to_string(kMinLevels) +
                            " to " + std::to_string(kMaxLevels));
  grid.levels = static_cast<int>(levels);
  const Field origin = field.at("origin");
  origin.expect_array(3);
  for (int axis = 0; axis < 3; ++axis) grid.origin[axis] = origin.at(axis).finite();
  grid.voxel_size = field.at("voxel_size").positive();
  grid.quantization_scale = field.at("quantization_scale").positive();
  const Vec3d far_corner = grid.bounds().hi;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(far_corner[axis])) field.fail("reaches beyond the finite numbers");
  if (!std::isfinite(1 / grid.voxel_size)) field.at("voxel_size").fail("too small");
  return grid;
}

std::vector<std::uint64_t> read_counts(const Field& field, int levels) {
  field.expect_array(static_cast<std::size_t>(levels));
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(levels));
  for (std::size_t level = 0; level < counts.size(); ++level)
    counts[level] = field.at(level).count();
  return counts;
}

}  // namespace

std::string vdag_metadata_json(const VdagMetadata& metadata) {
  const Grid& grid = metadata.grid;
  Json json;
  json["grid"] = {{"levels", grid.levels},
                  {"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                  {"voxel_size", grid.voxel_size},
                  {"quantization_scale", grid.quantization_scale}};
  json["counts"] = {{"voxels", metadata.counts.voxels},
                    {"svo_nodes_per_level", metadata.counts.svo_nodes_per_level},
                    {"dag_nodes_per_level", metadata.counts.dag_nodes_per_level}};
  json["source"] = {{"name", metadata.source.name},
                    {"vertices", metadata.source.vertices},
                    {"triangles", metadata.source.triangles}};
  json["program"] = metadata.program;
  json["build"] = metadata.build;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

VdagMetadata parse_vdag_metadata(std::string_view text) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw Error("", "byte " + std::to_string(error.byte), "not valid JSON");
  } catch (const Json::exception& error) {  // a number out of range
    throw Error("", "", std::string("not valid JSON: ") + error.what());
  }
  const Field root{json, ""};
  VdagMetadata metadata;
  metadata.grid = read_grid(root.at("grid"));
  const Field counts = root.at("counts"), source = root.at("source"), build = root.at("build");
  metadata.counts.voxels = counts.at("voxels").count();
  metadata.counts.svo_nodes_per_level =
      read_counts(counts.at("svo_nodes_per_level"), metadata.grid.levels);
  metadata.counts.dag_nodes_per_level =
      read_counts(counts.at("dag_nodes_per_level"), metadata.grid.levels);
  metadata.source.name = source.at("name").text();
  metadata.source.vertices = source.at("vertices").count();
  metadata.source.triangles = source.at("triangles").count();
  metadata.program = root.at("program").text();
  if (!build.value.is_object()) build.fail("not an object");
  for (const auto& [key, value] : build.value.items()) metadata.build[key] = build.at(key).text();
  return metadata;
}

}  // namespace voxdag
