#pragma once
/// Reads JSON files that people write. Errors name the key.
#include <nlohmann/json.hpp>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Reads a file or a pipe of at most `limit`. Throws Error with the byte if it is not JSON.
nlohmann::json read_json_file(const std::string& file, SizeLimit limit);

/// The place of a value in the file, for errors.
struct JsonPlace {
  const std::string& file;
  std::string name;

  [[noreturn]] void refuse(const std::string& reason) const { throw Error(file, name, reason); }
};

/// Returns a finite number. `member` is its key, for the error.
double json_number(const nlohmann::json& json, const JsonPlace& place, const std::string& member);

/// Returns a vector from an array of three finite numbers.
Vec3d json_vector(const nlohmann::json& json, const JsonPlace& place, const std::string& member);

/// Returns a vector that is not zero and has a finite length.
Vec3d json_direction(const nlohmann::json& json, const JsonPlace& place, const std::string& member);

}  // namespace voxdag
