#include "viewer/gzip/gzip.hpp"

namespace voxdag {

std::string gzip(std::string_view bytes) {
  std::string compressed;
  const auto append = [&compressed](std::string_view piece) { compressed += piece; };
  Gzip stream;
  stream.add(std::as_bytes(std::span(bytes)), append);
  stream.finish(append);
  return compressed;
}

}  // namespace voxdag
