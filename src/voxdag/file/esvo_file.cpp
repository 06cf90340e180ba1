#include "voxdag/file/esvo_file.hpp"

#include <utility>

#include "voxdag/core/with_file_name.hpp"

namespace voxdag {

EsvoFile::EsvoFile(VdagContainer file)
    : file_(std::move(file)),
      contents_(with_file_name(file_.path().string(), [&] { return parse_esvo(file_.bytes()); })) {}

}  // namespace voxdag
