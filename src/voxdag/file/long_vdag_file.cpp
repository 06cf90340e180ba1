#include "voxdag/file/long_vdag_file.hpp"

#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {

bool has_long_pointers(const std::filesystem::path& path) {
  const MappedFile file(path, MappedFile::Access::kRandom);
  try {
    return has_chunk(read_vdag_chunks(file.bytes()), kChunkLongNodes);
  } catch (const Error&) {
    return false;
  }
}

LongVdagFile::LongVdagFile(const std::filesystem::path& path)
    : file_(path, MappedFile::Access::kSequential) {
  with_file_name(path.string(), [&] {
    const std::vector<VdagChunk> chunks = read_vdag_chunks(file_.bytes());
    check_vdag_checksums(chunks);
    metadata_ = read_vdag_metadata(chunks);
    view_ = read_vdag_long_svdag(chunks, metadata_.grid.levels);
    check_vdag_svdag(view_, validate_svdag);
  });
}

}  // namespace voxdag
