#include "voxdag/file/compact_file.hpp"

#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"

namespace voxdag {

CompactSvdagView CompactContents::view() const {
  CompactSvdagView view = head.view();
  if (!view.is_empty())
    view.stream = chunk_values<std::uint32_t>(chunks, kChunkCompactStream).data();
  return view;
}

bool CompactContents::has_attributes() const { return has_attribute_values(chunks); }

DagAttributesView CompactContents::attributes(const CellIndexView& index,
                                              ExpandedChunks& expanded) const {
  std::vector<VdagChunk> in_pages = chunks;
  expand_wire_chunks(in_pages, expanded);
  return read_attribute_values(in_pages, index);
}

CompactContents parse_compact(std::span<const std::byte> file) {
  CompactContents contents;
  contents.chunks = read_vdag_chunks(file);
  if (!has_chunk(contents.chunks, kChunkCompactStream))
    throw Error("", "", "does not hold a compact DAG");
  check_vdag_checksums(contents.chunks);
  contents.metadata = read_vdag_metadata(contents.chunks);
  const auto stream = chunk_values<std::uint32_t>(contents.chunks, kChunkCompactStream);
  const std::span<const std::byte> head = chunk_bytes(contents.chunks, kChunkCompactHead, 1);
  contents.head_bytes = head.size();
  try {
    contents.head = parse_compact_head(head, contents.metadata.grid.levels, stream.size());
  } catch (const Error& error) {
    throw error.within(ErrorPlace::chunk("CHED"));
  }
  // Readers may load the word after the last bit.
  if (!stream.empty() && stream.back() != 0)
    throw Error("", ErrorPlace::chunk("CSTR"), "the last word is not zero");
  if (has_chunk(contents.chunks, kChunkCellIndex))
    throw Error("", ErrorPlace::chunk("CIDX"), "belongs to the plain form only");
  if (contents.has_attributes() && contents.metadata.attributes.resolution == 0)
    throw Error("", ErrorPlace::chunk("META") / "attributes",
                "is missing, but the file has attributes");
  return contents;
}

CompactFile::CompactFile(VdagContainer file) : file_(std::move(file)) {
  contents_ = with_file_name(file_.path().string(), [&] { return parse_compact(file_.bytes()); });
}

}  // namespace voxdag
