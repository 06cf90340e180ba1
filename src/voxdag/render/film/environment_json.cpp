#include "voxdag/render/film/environment_json.hpp"

#include <algorithm>
#include <string_view>

#include "voxdag/core/io/base64.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

constexpr const char* kMembers[] = {"name", "side", "texels", "sun", "towards"};

std::string full_name(std::string_view member) {
  return "\"environment.map" + std::string(member.empty() ? "" : ".").append(member) + "\"";
}

/// Throws Error unless the object has exactly kMembers.
void check_members(const Json& json, const JsonPlace& place) {
  if (!json.is_object())
    place.refuse(full_name("") + " is none of studio, overcast, sunset and a map");
  for (const char* const name : kMembers)
    if (!json.contains(name)) place.refuse(full_name(name) + " is missing");
  for (const auto& [name, value] : json.items())
    if (std::find(std::begin(kMembers), std::end(kMembers), name) == std::end(kMembers))
      place.refuse(full_name(name) + " is an unknown key");
}

}  // namespace

std::shared_ptr<const Environment> environment_of_json(const Json& json, const JsonPlace& place) {
  if (json.is_string() && is_built_in_environment(json.get<std::string>()))
    return std::make_shared<Environment>(built_in_environment(json.get<std::string>()));
  check_members(json, place);
  PackedEnvironment packed;
  const double side = json_number(json["side"], place, "environment.map.side");
  packed.side = static_cast<int>(side);
  if (!(side >= 2 && side <= PackedEnvironment::kMostSide) || side != packed.side)
    place.refuse(full_name("side") + " is no whole number from 2 to " +
                 std::to_string(PackedEnvironment::kMostSide));
  const auto bytes = json["texels"].is_string()
                         ? decode_base64(json["texels"].get_ref<const std::string&>())
                         : std::nullopt;
  const std::size_t wanted = std::size_t{4} * static_cast<std::size_t>(packed.side) *
                             static_cast<std::size_t>(packed.side);
  if (!bytes || bytes->size() != wanted)
    place.refuse(full_name("texels") + " is not the base64 of " + std::to_string(wanted) +
                 " bytes");
  packed.texels = *bytes;
  packed.sun_irradiance =
      static_cast<Vec3f>(json_vector(json["sun"], place, "environment.map.sun"));
  packed.sun_direction =
      static_cast<Vec3f>(json_vector(json["towards"], place, "environment.map.towards"));
  for (int c = 0; c < 3; ++c)
    if (!(packed.sun_irradiance[c] >= 0)) place.refuse(full_name("sun") + " is negative");
  try {
    return std::make_shared<Environment>(packed);
  } catch (const Error& error) {
    place.refuse(error.what());
  }
}

Json environment_json(const Environment& environment, const std::string& name) {
  constexpr int kSide = 256;
  const PackedEnvironment packed = environment.packed(kSide);
  const auto numbers = [](Vec3f v) { return Json::array({v.x, v.y, v.z}); };
  return {{"name", name},
          {"side", packed.side},
          {"texels", base64(packed.texels)},
          {"sun", numbers(packed.sun_irradiance)},
          {"towards", numbers(packed.sun_direction)}};
}

}  // namespace voxdag
