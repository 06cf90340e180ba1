#include "voxdag/core/io/this_process.hpp"

#include <fstream>
#include <system_error>

namespace voxdag {

std::filesystem::path path_of_program() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

std::string boot_id() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id;
}

}  // namespace voxdag
