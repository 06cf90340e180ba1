#pragma once
/// JSON in expectations.
#include <nlohmann/json.hpp>
#include <ostream>

namespace nlohmann {

/// GoogleTest takes a JSON value for a container of itself and would print it without end.
inline void PrintTo(const json& value, std::ostream* out) { *out << value.dump(); }

}  // namespace nlohmann
