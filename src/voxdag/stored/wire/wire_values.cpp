#include "voxdag/stored/wire/wire_values.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/wire/range_coder.hpp"

namespace voxdag::wire {
namespace {

/// The contexts in which the wire form codes the runs of material ids, and the fields that choose
/// among them. docs/format.md lists them. About 600 KB.
class MaterialModel {
 public:
  explicit MaterialModel(int id_bits) : id_bits_(id_bits) {}

  /// Does what ValueModel::code_page() does, for a page of runs.
  template <class Coder, class Bits>
  bool code_page(Coder& coder, Bits& bits) {
    std::uint32_t begin = 0;  ///< Of the run, in the page.
    int length_before = 0;
    for (;;) {
      if (!bits.has_room(id_bits_ + MaterialRun::kLastBits)) return false;
      const std::uint32_t id = code_id(coder, static_cast<std::uint32_t>(bits.take(id_bits_)));
      bits.put(id_bits_, id);
      const std::uint32_t slot = id * kSpread >> (32 - kSlotBits);
      const std::uint32_t left = std::min<std::uint32_t>(begin, kPageValues - 1) / 32;
      const bool is_last =
          coder.code(lasts_[left][slot][length_before], bits.take(MaterialRun::kLastBits) != 0);
      bits.put(MaterialRun::kLastBits, is_last ? 1 : 0);
      if (is_last) return true;
      if (!bits.has_room(MaterialRun::kLengthBits)) return false;
      const std::uint32_t below = sizes_[slot][length_before].code(
          coder, static_cast<std::uint32_t>(bits.take(MaterialRun::kLengthBits)));
      bits.put(MaterialRun::kLengthBits, below);
      const int width = static_cast<int>(below);
      if (!bits.has_room(width)) return false;
      const std::uint32_t rest =
          lengths_[below][slot].code(coder, static_cast<std::uint32_t>(bits.take(width)), width);
      bits.put(width, rest);
      begin += 1u << below | rest;
      length_before = width;
    }
  }

 private:
  static constexpr std::uint32_t kSpread = 0x9E3779B1u;  ///< 2^32 over the golden ratio.
  static constexpr int kIdContextBits = 16, kSlotBits = 6;
  static constexpr int kSlots = 1 << kSlotBits, kLengths = 1 << MaterialRun::kLengthBits;

  /// Codes an id, given the one before it. Ids share contexts at random.
  template <class Coder>
  std::uint32_t code_id(Coder& coder, std::uint32_t id) {
    std::uint32_t prefix = 1;
    for (int bit = id_bits_ - 1; bit >= 0; --bit) {
      const std::uint32_t context =
          (id_before_ * kSpread + prefix) * kSpread >> (32 - kIdContextBits);
      prefix =
          prefix << 1 | static_cast<std::uint32_t>(coder.code(ids_[context], (id >> bit & 1) != 0));
    }
    id_before_ = prefix - (1u << id_bits_);
    return id_before_;
  }

  int id_bits_;
  std::uint32_t id_before_ = 0;
  AdaptiveBit ids_[1 << kIdContextBits];
  AdaptiveBit lasts_[kPageValues / 32][kSlots][kLengths];
  BitTree<MaterialRun::kLengthBits> sizes_[kSlots][kLengths];
  BitTree<7> lengths_[kLengths][kSlots];
};

/// Reads the bits of pages.
struct PageSource {
  const std::uint64_t* words;
  std::uint64_t at = 0;

  std::uint64_t take(int width) {
    const std::uint64_t value = read_bits(words, at, width);
    at += static_cast<std::uint64_t>(width);
    return value;
  }
  void put(int, std::uint64_t) {}
  static bool has_room(int) { return true; }
};

/// Writes the bits of pages.
struct PageSink {
  std::uint64_t* words;
  std::uint64_t at = 0, end = 0;  ///< Bits.

  static std::uint64_t take(int) { return 0; }
  void put(int width, std::uint64_t value) {
    write_bits(words, at, width, value);
    at += static_cast<std::uint64_t>(width);
  }
  bool has_room(int width) const { return at + static_cast<std::uint64_t>(width) <= end; }
  void to_whole_byte() { at = (at + 7) / 8 * 8; }
};

[[noreturn]] void fail_segment(std::uint64_t segment, const std::string& reason) {
  throw Error("", "", "segment " + std::to_string(segment) + " " + reason);
}

/// `make_model` returns a model with fresh contexts.
template <class MakeModel>
WireValues encode(const CellPagesView& pages, const MakeModel& make_model) {
  WireValues wire;
  PageSource source{pages.words};
  std::uint64_t page = 0;
  while (page < pages.page_count()) {
    const auto model = make_model();
    RangeEncoder encoder(wire.bytes);
    do {
      source.at = pages.page_begin(page);
      model->code_page(encoder, source);
    } while (++page < pages.page_count() && page % kSegmentPages != 0);
    encoder.finish();
    wire.segments.push_back({wire.bytes.size(), (source.at + 7) / 8});
  }
  return wire;
}

template <class MakeModel>
void decode(std::span<const WireSegment> segments, std::span<const std::byte> bytes,
            const PagesTarget& target, const MakeModel& make_model) {
  const std::uint64_t count = CellPagesView{.values = target.values}.page_count();
  if (segments.size() != segment_count(count))
    throw Error("", "",
                "has " + std::to_string(segments.size()) + " segments instead of " +
                    std::to_string(segment_count(count)));
  PageSink sink{target.words};
  std::uint64_t coded = 0;
  for (std::uint64_t s = 0; s < segments.size(); ++s) {
    const WireSegment& segment = segments[s];
    if (segment.coded_end < coded || segment.coded_end > bytes.size())
      fail_segment(s, "ends outside of the coded bytes");
    if (segment.page_end < sink.at / 8 || segment.page_end > 8 * target.word_count)
      fail_segment(s, "has pages outside of the words");
    RangeDecoder decoder(bytes.subspan(coded, segment.coded_end - coded));
    coded = segment.coded_end;
    const auto model = make_model();
    sink.end = 8 * segment.page_end;
    const std::uint64_t first = s * kSegmentPages;
    for (std::uint64_t page = first; page < std::min(first + kSegmentPages, count); ++page) {
      std::uint64_t& group = target.groups[page / kGroupPages];
      if (page % kGroupPages == 0) group = sink.at / 8;
      target.pages[page] = static_cast<std::uint16_t>(sink.at / 8 - group);
      if (!model->code_page(decoder, sink)) fail_segment(s, "has more than its pages hold");
      sink.to_whole_byte();
    }
    if (sink.at != sink.end || !decoder.is_at_end())
      fail_segment(s, "does not end where it should");
  }
  if (coded != bytes.size()) throw Error("", "", "has bytes after its last segment");
}

auto value_models(PagePrecision precision, ValueKind kind) {
  return [=] { return std::make_unique<ValueModel>(precision, kind); };
}

auto material_models(std::uint32_t materials) {
  MaterialIdsView view;
  view.materials = materials;
  return [bits = view.id_bits()] { return std::make_unique<MaterialModel>(bits); };
}

}  // namespace

WireValues encode_wire_values(const ValuePagesView& pages, ValueKind kind) {
  return encode(pages, value_models(pages.precision, kind));
}

WireValues encode_wire_materials(const MaterialIdsView& pages) {
  return encode(pages, material_models(pages.materials));
}

void decode_wire_values(std::span<const WireSegment> segments, std::span<const std::byte> bytes,
                        PagePrecision precision, ValueKind kind, const PagesTarget& target) {
  decode(segments, bytes, target, value_models(precision, kind));
}

void decode_wire_materials(std::span<const WireSegment> segments, std::span<const std::byte> bytes,
                           std::uint32_t materials, const PagesTarget& target) {
  decode(segments, bytes, target, material_models(materials));
}

}  // namespace voxdag::wire
