#include "voxdag/readers/ply/ply_reader.hpp"

#include "voxdag/readers/ply/ply_rows.hpp"

namespace voxdag {

Mesh read_ply(const MeshBytes& source) {
  if (source.bytes.empty()) throw source.error("the file is empty");
  const PlyHeader header = parse_ply_header(source);
  return header.format == PlyFormat::kAscii ? read_ply_ascii(source, header)
                                            : read_ply_binary(source, header);
}

}  // namespace voxdag
