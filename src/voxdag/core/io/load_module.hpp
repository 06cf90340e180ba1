#pragma once
/// Loads modules: parts of the program whose libraries few commands need.
#include <string>

namespace voxdag {

/// Loads a shared library that lies where the program's RPATH says, and returns the address of a
/// symbol in it; null if it cannot be loaded, and then `reason` tells why. The library stays
/// loaded.
const void* load_module(const char* file, const char* symbol, std::string& reason);

}  // namespace voxdag
