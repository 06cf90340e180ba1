#pragma once
/// The chunks of a DAG's attributes.
///
/// CIDX, the numbers of cells:
///   0    CellIndexHeader   64 bytes
///   64   CellIndexView::words
///
/// COLR and NRML, the values of cells:
///   0    ValuePagesHeader  64 bytes
///   64   ValuePagesView::groups, ::words, ::pages
///
/// MTID, the materials of cells:
///   0    MaterialIdsHeader  64 bytes
///   64   MaterialIdsView::groups, ::words, ::pages
///
/// CHAN, the channels of cells: ChannelsView::words
#include <memory>
#include <span>
#include <vector>

#include "voxdag/file/attribute_form.hpp"
#include "voxdag/file/output_chunk.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/wire/value_model.hpp"

namespace voxdag {

class WireChunk;

struct CellIndexHeader {
  std::uint32_t finest_level;
  std::uint32_t reserved;  ///< Zero.
  std::uint64_t cells;
  std::uint8_t width[kMaxLevels];
  std::uint8_t padding[28];  ///< Zero.
};
static_assert(sizeof(CellIndexHeader) == 64 && offsetof(CellIndexHeader, width) == 16);

struct ValuePagesHeader {
  std::uint32_t precision;
  std::uint32_t reserved;  ///< Zero.
  std::uint64_t values;
  std::uint64_t words;
  std::uint64_t padding[5];  ///< Zero.
};
static_assert(sizeof(ValuePagesHeader) == 64);

struct MaterialIdsHeader {
  std::uint32_t materials;
  std::uint32_t reserved;  ///< Zero.
  std::uint64_t values;
  std::uint64_t words;
  std::uint64_t padding[5];  ///< Zero.
};
static_assert(sizeof(MaterialIdsHeader) == 64);

/// The bytes of the chunks of attributes. Refers to the attributes and owns the headers.
class AttributeChunks {
 public:
  enum class Index { kStored, kLeftOut };

  /// `index` says whether the chunk CIDX is among the chunks, `form` whether COLR and NRML have the
  /// wire form.
  AttributeChunks(const DagAttributesView& attributes, Index index,
                  AttributeForm form = AttributeForm::kPages);
  ~AttributeChunks();
  AttributeChunks(const AttributeChunks&) = delete;
  AttributeChunks& operator=(const AttributeChunks&) = delete;

  /// Returns the chunks in the order of the file; none if there are no attributes.
  const std::vector<OutputChunk>& chunks() const { return chunks_; }

 private:
  template <class View, class Header>
  void add(std::uint32_t id, const View& pages, Header& header);
  /// Adds the chunk if a reader accepts it. Returns whether it did.
  bool add_wire(std::unique_ptr<WireChunk> chunk);

  CellIndexHeader index_{};
  ValuePagesHeader colors_{}, normals_{};
  MaterialIdsHeader materials_{};
  std::vector<std::unique_ptr<WireChunk>> wire_;
  std::vector<OutputChunk> chunks_;
};

/// Returns whether the file has values of cells: COLR, NRML or MTID, in either form, or
/// CHAN.
bool has_attribute_values(const std::vector<VdagChunk>& chunks);

/// Reads and checks the attributes of a valid DAG; returns an empty view if the file has none. The
/// result refers to the chunks and is safe to read. Linear time. Throws Error, whose place begins
/// with the chunk.
DagAttributesView read_attribute_chunks(const std::vector<VdagChunk>& chunks, const SvdagView& dag);

/// Reads and checks the values of the cells that `index` numbers, in a file without CIDX. The
/// result refers to the chunks and to the words of `index`. Throws Error like
/// read_attribute_chunks().
DagAttributesView read_attribute_values(const std::vector<VdagChunk>& chunks,
                                        const CellIndexView& index);

}  // namespace voxdag
