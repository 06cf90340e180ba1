#include "voxdag/formats/readers/ply/ply_reader.hpp"

#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"
#include "voxdag/formats/readers/ply/ply_rows.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

MeshWithAppearance read_ply(const MeshSource& source, ReadParts parts) {
  const PlyHeader header = parse_ply_header(source);
  const NamedFiles files(source);
  for (const std::string_view name : header.textures)
    if (const auto file = files.existing(source.folder, name, NamedFiles::ByBaseName::kAlways))
      files.report(*file);
  const PlyFields fields(header);
  std::optional<PlyAttributes> attributes;
  MeshWithAppearance result;
  MemoryReservation memory(source.work().memory, 0);
  const auto read = [&](bool to_255) {
    result.mesh = {};
    if (parts == ReadParts::kMeshAndAppearance) attributes.emplace(source, header, fields, to_255);
    const PlyBody body{source, header, fields, attributes ? &*attributes : nullptr};
    result.mesh = header.format == PlyFormat::kAscii ? read_ply_ascii(body, memory)
                                                     : read_ply_binary(body, memory);
  };
  read(false);
  if (!header.version.empty())
    result.warnings.push_back(source.name + ": PLY version " + in_quotes(header.version) +
                              ": read as 1.0");
  if (!attributes) return result;
  if (attributes->go_to_255()) {
    read(true);
    result.warnings.push_back(colors_to_255_warning(source.name));
  }
  result.appearance = attributes->finish(result.mesh, result.warnings);
  return result;
}

}  // namespace voxdag
