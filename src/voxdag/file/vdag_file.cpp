#include "voxdag/file/vdag_file.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {

VdagFile::VdagFile(const std::filesystem::path& path) : mapping_(path) {
  try {
    contents_ = parse_vdag(mapping_.bytes());
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace voxdag
