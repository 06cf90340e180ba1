#pragma once
/// Which numbers an option takes: for CLI::Option::check(), which makes others a usage error.
#include <CLI/CLI.hpp>
#include <cstdint>

namespace voxdag {

/// A whole number, both ends included.
CLI::Validator whole_number(std::int64_t least, std::int64_t most);

/// A number, both ends included.
CLI::Validator number_from(double least, double most);

/// A number, neither end included.
CLI::Validator number_between(double low, double high);

/// A number that is positive and finite also as a float.
CLI::Validator positive_number();

}  // namespace voxdag
