#include "voxdag/file/esvo_file.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/io/mapped_file.hpp"

namespace voxdag {
namespace {

template <class Work>
auto with_file_name(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace

EsvoFile::EsvoFile(const std::filesystem::path& path)
    : file_(path), contents_(with_file_name(path, [&] { return parse_esvo(file_.bytes()); })) {}

bool is_esvo_file(const std::filesystem::path& path) {
  const MappedFile mapping(path, MappedFile::Access::kRandom);
  return with_file_name(path, [&] { return is_esvo(read_vdag_chunks(mapping.bytes())); });
}

}  // namespace voxdag
