#pragma once
/// Describes the machine of the measurements.
#include <nlohmann/json.hpp>
#include <string>

namespace voxdag::lab {

/// Returns program, version and, if it is known, commit: "voxdag 0.1.0 (fb94950)".
std::string program_name();

/// Returns processor, cores, memory, system, time and load as JSON.
nlohmann::ordered_json machine_json();

}  // namespace voxdag::lab
