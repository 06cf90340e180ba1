#include "voxdag/film/path_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "voxdag/core/error.hpp"
#include "voxdag/io/open_input.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

/// The place of a value in the file, for errors.
struct Place {
  const std::string& file;
  std::string name;

  [[noreturn]] void refuse(const std::string& reason) const { throw Error(file, name, reason); }
};

double number(const Json& json, const Place& place, const std::string& member) {
  if (!json.is_number() || !std::isfinite(json.get<double>()))
    place.refuse("\"" + member + "\" is not a number");
  return json.get<double>();
}

Vec3d vector(const Json& json, const Place& place, const std::string& member) {
  if (!json.is_array() || json.size() != 3)
    place.refuse("\"" + member + "\" is not an array of three numbers");
  Vec3d v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = number(json[static_cast<std::size_t>(axis)], place, member);
  return v;
}

PathKey key_of(const Json& json, const Place& place) {
  if (!json.is_object()) place.refuse("not an object");
  for (const char* member : {"time", "eye", "target"})
    if (!json.contains(member)) place.refuse(std::string("\"") + member + "\" is missing");
  PathKey key;
  for (const auto& [member, value] : json.items()) {
    if (member == "time")
      key.time = number(value, place, member);
    else if (member == "eye")
      key.eye = vector(value, place, member);
    else if (member == "target")
      key.target = vector(value, place, member);
    else if (member == "up")
      key.up = vector(value, place, member);
    else if (member == "fov")
      key.fov_degrees = number(value, place, member);
    else
      place.refuse("unknown key \"" + member + "\": the keys are time, eye, target, up and fov");
  }
  return key;
}

constexpr std::uint64_t kMaxPathFileBytes = std::uint64_t{16} << 20;

Json parse(const std::string& file) {
  const std::string text =
      read_input(file, {kMaxPathFileBytes, "a camera path"}, InputKind::kFileOrPipe);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ..."
    std::string reason = error.what();
    if (const std::size_t at = reason.find("syntax error"); at != std::string::npos)
      reason.erase(0, at);
    throw Error(file, ErrorPlace::byte(error.byte), reason);
  } catch (const Json::exception&) {  // thrown for a number out of the range of double
    throw Error(file, "", "a number is out of range");
  }
}

std::string vector_text(Vec3d v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }

}  // namespace

PathFile read_path_file(const std::string& path) {
  const Json json = parse(path);
  const Place place{path, ""};
  if (!json.is_object() || !json.contains("keys") || !json["keys"].is_array())
    place.refuse("must be an object with an array \"keys\"");
  PathFile file;
  file.name = path;
  for (const auto& [member, value] : json.items()) {
    if (member == "sun") {
      file.sun = vector(value, place, member);
      const double length2 = dot(*file.sun, *file.sun);
      if (!(length2 > 0 && length2 < HUGE_VAL))
        place.refuse("\"sun\" must be a direction: finite and not zero");
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
