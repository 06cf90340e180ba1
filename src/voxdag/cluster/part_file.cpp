#include "voxdag/cluster/part_file.hpp"

#include <algorithm>

#include "voxdag/core/checked_size.hpp"

namespace voxdag {
namespace {

struct PieceHeader {
  std::uint32_t level, first, last, levels;
  std::uint64_t leaf_blocks;
  std::uint64_t level_begin[kMaxLevels + 1];
};
static_assert(sizeof(PieceHeader) % 8 == 0);

std::uint64_t padding(std::uint64_t node_words) { return node_words % 2 * sizeof(std::uint32_t); }

}  // namespace

void write_piece(WorkFileWriter& file, const CellRange& range, const SvdagView& dag) {
  PieceHeader header{static_cast<std::uint32_t>(range.level), range.first,          range.last,
                     static_cast<std::uint32_t>(dag.levels),  dag.leaf_block_count, {}};
  std::copy(std::begin(dag.level_begin), std::end(dag.level_begin), header.level_begin);
  constexpr std::byte kZeros[8] = {};
  file.write_value(header);
  file.write(std::as_bytes(std::span(dag.nodes, dag.node_words())));
  file.write({kZeros, checked_size(padding(dag.node_words()))});
  file.write(std::as_bytes(std::span(dag.leaf_blocks, dag.leaf_block_count)));
}

namespace {

std::vector<PartPiece> read_pieces(const WorkFile& file) {
  std::vector<PartPiece> pieces;
  const std::byte* at = file.bytes().data();
  for (const std::byte* const end = at + file.bytes().size(); at != end;) {
    const auto& header = *reinterpret_cast<const PieceHeader*>(at);
    at += sizeof header;
    PartPiece piece{{static_cast<int>(header.level), header.first, header.last}, {}};
    piece.dag.levels = static_cast<int>(header.levels);
    std::copy(std::begin(header.level_begin), std::end(header.level_begin), piece.dag.level_begin);
    piece.dag.nodes = reinterpret_cast<const std::uint32_t*>(at);
    at += piece.dag.node_words() * sizeof(std::uint32_t) + padding(piece.dag.node_words());
    piece.dag.leaf_blocks = reinterpret_cast<const std::uint64_t*>(at);
    piece.dag.leaf_block_count = header.leaf_blocks;
    at += header.leaf_blocks * sizeof(std::uint64_t);
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace

const PartFile& PartFiles::get(std::uint64_t part) {
  {
    const std::lock_guard guard(mutex_);
    const auto found = open_.find(part);
    if (found != open_.end()) return found->second;
  }
  WorkFile file = folder_.open_written(part_name(part), work_);
  std::vector<PartPiece> pieces = read_pieces(file);
  const std::lock_guard guard(mutex_);
  return open_.emplace(part, PartFile{std::move(file), std::move(pieces)}).first->second;
}

std::string part_name(std::uint64_t part) { return "parts/" + std::to_string(part); }

}  // namespace voxdag
