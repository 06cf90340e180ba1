#include "voxdag/file/vdag_file.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"

namespace voxdag {

VdagFile::VdagFile(VdagContainer file) : file_(std::move(file)) {
  contents_ = with_file_name(file_.path().string(), [&] { return parse_vdag(file_.bytes()); });
}

}  // namespace voxdag
