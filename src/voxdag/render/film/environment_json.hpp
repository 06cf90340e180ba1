#pragma once
/// Environments in the settings of a view: the value of "environment.map". A built-in one is its
/// name; another is an object with its map, which the viewer and `render --view` show alike.
#include <memory>

#include "voxdag/render/environment.hpp"
#include "voxdag/render/film/json_file.hpp"

namespace voxdag {

/// Returns the environment of a name or an object. Throws Error, which names the key, for another
/// name, a member that is missing, unknown or wrong, and a map that is black.
std::shared_ptr<const Environment> environment_of_json(const nlohmann::json& json,
                                                       const JsonPlace& place);

/// Returns an environment as an object, with a map of at most 256² texels: some 350 KB of JSON.
/// `name` is what people see.
nlohmann::json environment_json(const Environment& environment, const std::string& name);

}  // namespace voxdag
