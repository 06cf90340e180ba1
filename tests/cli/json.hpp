#pragma once
/// Prints JSON in failed expectations.
#include <nlohmann/json.hpp>
#include <ostream>

namespace nlohmann {

/// Prints a JSON value. Without this, GoogleTest would treat the value as a container of itself and
/// print it endlessly.
inline void PrintTo(const json& value, std::ostream* out) { *out << value.dump(); }

}  // namespace nlohmann
