#include "voxdag/file/vdag_file.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"

namespace voxdag {

VdagFile::VdagFile(const std::filesystem::path& path) : file_(path) {
  contents_ = with_file_name(path.string(), [&] { return parse_vdag(file_.bytes()); });
}

}  // namespace voxdag
