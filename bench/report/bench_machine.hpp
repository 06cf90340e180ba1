#pragma once
/// The machine that figures were measured on.
#include <nlohmann/json.hpp>
#include <string>

namespace voxdag {

/// This program, its version and, where the build knew it, its commit: "voxdag 0.1.0 (fb94950)".
std::string program_name();

/// Processor, cores, memory, system, time and load: a figure says little without them.
nlohmann::ordered_json machine_json();

/// Processes that wanted to run in the last minute, in the mean; above 0 before a measurement
/// means that others were using the machine.
double load_average();

}  // namespace voxdag
