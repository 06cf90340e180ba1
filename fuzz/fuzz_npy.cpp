/// Fuzzes the header parser of .npy: any text gives a header or an Error.
#include <cstddef>
#include <cstdint>

#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    voxdag::parse_npy_header({reinterpret_cast<const char*>(data), size}, 10);
  } catch (const voxdag::Error&) {
  }
  return 0;
}
