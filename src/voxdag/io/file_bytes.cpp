#include "voxdag/io/file_bytes.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {

std::vector<std::uint8_t> read_image_bytes(const std::filesystem::path& path) {
  // Before it is opened: that would wait for the writer of a named pipe.
  std::error_code ec;
  const std::filesystem::file_status status = std::filesystem::status(path, ec);
  if (std::filesystem::is_directory(status)) throw Error(path.string(), "", "is a directory");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw Error(path.string(), "", "is not a regular file");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw Error(path.string(), "", std::string("cannot open: ") + std::strerror(errno));
  const std::streamoff size = in.tellg();
  if (size < 0) throw Error(path.string(), "", "cannot tell its size");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);
  if (in.gcount() != size) throw Error(path.string(), "", "cannot read it to its end");
  return bytes;
}

void write_image_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace voxdag
