#include "voxdag/file/long_vdag_file.hpp"

#include <utility>

#include "voxdag/core/with_file_name.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {

LongVdagFile::LongVdagFile(VdagContainer file) : file_(std::move(file)) {
  with_file_name(file_.path().string(), [&] {
    const std::vector<VdagChunk> chunks = read_vdag_chunks(file_.bytes());
    check_vdag_checksums(chunks);
    metadata_ = read_vdag_metadata(chunks);
    view_ = read_vdag_long_svdag(chunks, metadata_.grid.levels);
    check_vdag_svdag(view_, validate_svdag);
  });
}

}  // namespace voxdag
