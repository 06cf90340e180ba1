#pragma once
/// Vectors as JSON.
#include <nlohmann/json.hpp>

#include "voxdag/core/vec.hpp"

namespace voxdag {

inline nlohmann::ordered_json json_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline nlohmann::ordered_json json_of(const Vec3f& v) { return {v.x, v.y, v.z}; }

}  // namespace voxdag
