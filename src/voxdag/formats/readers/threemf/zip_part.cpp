#include "voxdag/formats/readers/threemf/zip_part.hpp"

#include <minizip/unzip.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

namespace voxdag {
namespace {

/// Where minizip is in the bytes of the archive.
struct Cursor {
  std::string_view bytes;
  ZPOS64_T at = 0;
};

Cursor& cursor(voidpf stream) { return *static_cast<Cursor*>(stream); }

/// Lets minizip read the bytes in memory. It never writes.
zlib_filefunc64_def functions_for(Cursor& archive) {
  zlib_filefunc64_def functions{};
  functions.opaque = &archive;
  functions.zopen64_file = [](voidpf opaque, const void*, int) { return opaque; };
  functions.zread_file = [](voidpf, voidpf stream, void* to, uLong size) -> uLong {
    Cursor& c = cursor(stream);
    const std::string_view part = c.bytes.substr(std::min<ZPOS64_T>(c.at, c.bytes.size()), size);
    std::memcpy(to, part.data(), part.size());
    c.at += part.size();
    return part.size();
  };
  functions.zwrite_file = [](voidpf, voidpf, const void*, uLong) -> uLong { return 0; };
  functions.ztell64_file = [](voidpf, voidpf stream) { return cursor(stream).at; };
  functions.zseek64_file = [](voidpf, voidpf stream, ZPOS64_T offset, int origin) -> long {
    Cursor& c = cursor(stream);
    c.at = offset + (origin == ZLIB_FILEFUNC_SEEK_CUR   ? c.at
                     : origin == ZLIB_FILEFUNC_SEEK_END ? c.bytes.size()
                                                        : 0);
    return c.at <= c.bytes.size() ? 0 : -1;
  };
  functions.zclose_file = [](voidpf, voidpf) { return 0; };
  functions.zerror_file = [](voidpf, voidpf) { return 0; };
  return functions;
}

}  // namespace

bool read_zip_part(const MeshSource& source, std::string_view name,
                   const std::function<void(std::string_view)>& use) {
  constexpr int kIgnoreCase = 2;
  Cursor archive{source.bytes};
  zlib_filefunc64_def functions = functions_for(archive);
  const std::unique_ptr<std::remove_pointer_t<unzFile>, decltype(&unzClose)> zip(
      unzOpen2_64("", &functions), &unzClose);
  if (!zip) throw source.error("is no ZIP archive, or its directory is damaged");
  std::string entry(name.substr(name.starts_with('/') ? 1 : 0));
  const auto is_found = [&] {
    return unzLocateFile(zip.get(), entry.c_str(), kIgnoreCase) == UNZ_OK;
  };
  if (!is_found()) {
    std::replace(entry.begin(), entry.end(), '/', '\\');  // as some programs of Windows write it
    if (!is_found()) return false;
  }
  const auto fail = [&] { throw Error(source.name, entry, "cannot be unpacked: it is damaged"); };
  if (unzOpenCurrentFile(zip.get()) != UNZ_OK) fail();
  std::vector<char> part(std::size_t{1} << 18);
  int count = 0;
  while ((count = unzReadCurrentFile(zip.get(), part.data(), static_cast<unsigned>(part.size()))) >
         0)
    use({part.data(), static_cast<std::size_t>(count)});
  if (count < 0 || unzCloseCurrentFile(zip.get()) != UNZ_OK) fail();  // Closing checks the CRC.
  return true;
}

}  // namespace voxdag
