#include "voxdag/file/esvo_file.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/with_file_name.hpp"

namespace voxdag {

EsvoFile::EsvoFile(const std::filesystem::path& path)
    : file_(path),
      contents_(with_file_name(path.string(), [&] { return parse_esvo(file_.bytes()); })) {}

bool is_esvo_file(const std::filesystem::path& path) {
  const MappedFile mapping(path, MappedFile::Access::kRandom);
  return with_file_name(path.string(), [&] { return is_esvo(read_vdag_chunks(mapping.bytes())); });
}

}  // namespace voxdag
