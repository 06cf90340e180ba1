#include "voxdag/file/vdag_file.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {

VdagFile::VdagFile(const std::filesystem::path& path) : file_(path) {
  try {
    contents_ = parse_vdag(file_.bytes());
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace voxdag
