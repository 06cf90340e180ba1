#include "voxdag/render/film/json_file.hpp"

#include <cmath>

namespace voxdag {

nlohmann::json read_json_file(const std::string& file, SizeLimit limit) {
  const std::string text = read_input(file, limit, InputKind::kFileOrPipe);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error ..."
    std::string reason = error.what();
    if (const std::size_t at = reason.find("syntax error"); at != std::string::npos)
      reason.erase(0, at);
    throw Error(file, ErrorPlace::byte(error.byte), reason);
  } catch (const nlohmann::json::exception&) {  // thrown for a number out of the range of double
    throw Error(file, "", "a number is out of range");
  }
}

double json_number(const nlohmann::json& json, const JsonPlace& place, const std::string& member) {
  if (!json.is_number() || !std::isfinite(json.get<double>()))
    place.refuse("\"" + member + "\" is not a number");
  return json.get<double>();
}

Vec3d json_vector(const nlohmann::json& json, const JsonPlace& place, const std::string& member) {
  if (!json.is_array() || json.size() != 3)
    place.refuse("\"" + member + "\" is not an array of three numbers");
  Vec3d v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = json_number(json[static_cast<std::size_t>(axis)], place, member);
  return v;
}

Vec3d json_direction(const nlohmann::json& json, const JsonPlace& place,
                     const std::string& member) {
  const Vec3d v = json_vector(json, place, member);
  const double length2 = dot(v, v);
  if (!(length2 > 0 && length2 < HUGE_VAL))
    place.refuse("\"" + member + "\" must be a direction: finite and not zero");
  return v;
}

}  // namespace voxdag
