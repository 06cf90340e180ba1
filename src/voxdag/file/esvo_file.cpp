#include "voxdag/file/esvo_file.hpp"

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

template <class Work>
auto named(const std::filesystem::path& path, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw error.in_file(path.string());
  }
}

}  // namespace

EsvoFile::EsvoFile(const std::filesystem::path& path)
    : mapping_(path), contents_(named(path, [&] { return parse_esvo(mapping_.bytes()); })) {}

bool is_esvo_file(const std::filesystem::path& path) {
  const MappedFile mapping(path);
  return named(path, [&] { return is_esvo(read_vdag_chunks(mapping.bytes())); });
}

}  // namespace voxdag
