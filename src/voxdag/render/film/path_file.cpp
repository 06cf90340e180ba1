#include "voxdag/render/film/path_file.hpp"

#include <fmt/format.h>

#include "voxdag/render/film/json_file.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

PathKey key_of(const Json& json, const JsonPlace& place) {
  if (!json.is_object()) place.refuse("not an object");
  for (const char* member : {"time", "eye", "target"})
    if (!json.contains(member)) place.refuse(std::string("\"") + member + "\" is missing");
  PathKey key;
  for (const auto& [member, value] : json.items()) {
    if (member == "time")
      key.time = json_number(value, place, member);
    else if (member == "eye")
      key.eye = json_vector(value, place, member);
    else if (member == "target")
      key.target = json_vector(value, place, member);
    else if (member == "up")
      key.up = json_vector(value, place, member);
    else if (member == "fov")
      key.fov_degrees = json_number(value, place, member);
    else
      place.refuse("unknown key \"" + member + "\": the keys are time, eye, target, up and fov");
  }
  return key;
}

constexpr std::uint64_t kMaxPathFileBytes = std::uint64_t{16} << 20;

std::string vector_text(Vec3d v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }

}  // namespace

PathFile read_path_file(const std::string& path) {
  const Json json = read_json_file(path, {kMaxPathFileBytes, "a camera path"});
  const JsonPlace place{path, ""};
  if (!json.is_object() || !json.contains("keys") || !json["keys"].is_array())
    place.refuse("must be an object with an array \"keys\"");
  PathFile file;
  file.name = path;
  for (const auto& [member, value] : json.items()) {
    if (member == "sun") {
      file.sun = json_direction(value, place, member);
    } else if (member != "keys")
      place.refuse("unknown key \"" + member + "\": the keys are keys and sun");
  }
  for (const Json& key : json["keys"])
    file.keys.push_back(key_of(key, {path, "key " + std::to_string(file.keys.size())}));
  return file;
}

std::string path_json(const PathFile& path) {
  std::string out = "{\n";
  if (path.sun) out += fmt::format("  \"sun\": {},\n", vector_text(*path.sun));
  out += "  \"keys\": [";
  for (const PathKey& key : path.keys) {
    out += fmt::format("{}\n    {{\"time\": {:.6g}, \"eye\": {}, \"target\": {}",
                       &key == path.keys.data() ? "" : ",", key.time, vector_text(key.eye),
                       vector_text(key.target));
    if (key.up) out += fmt::format(", \"up\": {}", vector_text(*key.up));
    if (key.fov_degrees) out += fmt::format(", \"fov\": {:.6g}", *key.fov_degrees);
    out += "}";
  }
  return out + "\n  ]\n}\n";
}

CameraPath make_camera_path(const PathFile& file, const VoxelSet& scene, const Grid& grid,
                            double aspect, const ViewRequest& first) {
  std::vector<CameraKey> keys;
  try {
    for (const PathKey& key : file.keys) {
      const ViewRequest before = keys.empty() ? first : as_request(keys.back().view);
      ViewRequest request{key.eye, key.target, key.up, key.fov_degrees};
      request.scene_up = first.scene_up;
      if (!key.up) request.up = before.up;
      if (!key.fov_degrees) request.vertical_fov_degrees = before.vertical_fov_degrees;
      keys.push_back({key.time, frame_scene(scene, grid, aspect, request)});
    }
    return CameraPath(std::move(keys));
  } catch (const Error& error) {
    throw Error(file.name,
                error.place().empty() ? fmt::format("key {}", keys.size()) : error.place(),
                error.reason());
  }
}

}  // namespace voxdag
