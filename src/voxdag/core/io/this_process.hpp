#pragma once
/// The program that runs, and the machine that it runs on.
#include <filesystem>
#include <string>

namespace voxdag {

/// Returns the path of the program's file; an empty path if the system does not tell it.
std::filesystem::path path_of_program();

/// Returns a name that the machine has until it boots again, equal in all of its containers; an
/// empty text if the system gives none.
std::string boot_id();

}  // namespace voxdag
