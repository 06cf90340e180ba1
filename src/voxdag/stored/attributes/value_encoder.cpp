#include "voxdag/stored/attributes/value_encoder.hpp"

#include <algorithm>

#include "voxdag/stored/attributes/fit_block.hpp"

namespace voxdag {

ValueEncoder::ValueEncoder(std::uint64_t values, const ValueMetric& metric, MemoryBudget* memory)
    : ValueEncoder(values, metric, choose_precision(metric), memory) {}

ValueEncoder::ValueEncoder(std::uint64_t values, const ValueMetric& metric, PagePrecision precision,
                           MemoryBudget* memory)
    : values_(values),
      metric_(metric),
      precision_(precision),
      memory_(memory),
      open_(memory),
      places_((values + kPageValues - 1) / kPageValues, {}, memory) {}

void ValueEncoder::add(std::uint64_t first, std::span<const Value8> values) {
  while (!values.empty()) {
    const std::uint64_t page = first / kPageValues;
    const std::size_t count =
        std::min<std::size_t>(values.size(), kPageValues - first % kPageValues);
    if (count == kPageValues && !copies())
      keep(page, encode_page(values.first<kPageValues>(), metric_, precision_));
    else
      add_part(first, count, [&](OpenPage& open) {
        std::copy_n(values.begin(), count,
                    open.values.begin() + static_cast<std::ptrdiff_t>(first % kPageValues));
      });
    first += count;
    values = values.subspan(count);
  }
}

bool ValueEncoder::can_store(Value8 value) const {
  return precision_.unpack(pack_end(value, precision_)) == value;
}

void ValueEncoder::copy(std::uint64_t first, std::uint64_t count, const ValuePagesView& from,
                        std::uint64_t from_first) {
  while (count > 0) {
    const std::uint64_t here = std::min(count, kPageValues - first % kPageValues);
    const CopiedValues part{static_cast<int>(first % kPageValues), static_cast<int>(here), from,
                            from_first};
    if (here == kPageValues)
      keep(first / kPageValues, join_page({}, {&part, 1}, kPageValues, metric_, precision_));
    else
      add_part(first, here, [&](OpenPage& open) { open.copies.push_back(part); });
    first += here;
    from_first += here;
    count -= here;
  }
}

template <class Set>
void ValueEncoder::add_part(std::uint64_t first, std::uint64_t count, const Set& set) {
  const std::uint64_t page = first / kPageValues, begin = page * kPageValues;
  const std::uint64_t whole = std::min<std::uint64_t>(kPageValues, values_ - begin);
  OpenPage complete;
  {
    const std::lock_guard lock(mutex_);
    OpenPage& open = open_[page];
    set(open);
    open.count += count;
    if (open.count < whole) return;
    complete = std::move(open);
    open_.erase(page);
  }
  if (copies()) {
    std::sort(complete.copies.begin(), complete.copies.end(),
              [](const CopiedValues& a, const CopiedValues& b) { return a.begin < b.begin; });
    return keep(page, join_page(complete.values, complete.copies, static_cast<int>(whole), metric_,
                                precision_));
  }
  std::fill(complete.values.begin() + static_cast<std::ptrdiff_t>(whole), complete.values.end(),
            complete.values[whole - 1]);
  keep(page, encode_page(complete.values, metric_, precision_, static_cast<int>(whole)));
}

/// Stores a compressed page.
void ValueEncoder::keep(std::uint64_t page, const EncodedPage& encoded) {
  const auto words = static_cast<std::size_t>((encoded.bits + 63) / 64);
  const std::lock_guard lock(mutex_);
  if (chunks_.empty() || chunks_.back().size() + words > kChunkWords) {
    chunks_.emplace_back(memory_);
    chunks_.back().reserve(kChunkWords);
  }
  CountedVector<std::uint64_t>& chunk = chunks_.back();
  places_[page] = {static_cast<std::uint32_t>(chunks_.size() - 1),
                   static_cast<std::uint16_t>(chunk.size()),
                   static_cast<std::uint16_t>((encoded.bits + 7) / 8)};
  chunk.insert(chunk.end(), encoded.words.begin(),
               encoded.words.begin() + static_cast<std::ptrdiff_t>(words));
  errors_ += encoded.errors;
  if (encoded.rounds_copies) rounds_copies_ = true;
}

ValuePages ValueEncoder::finish() {
  ValuePages pages;
  pages.values = values_;
  pages.precision = precision_;
  std::uint64_t bytes = 0;
  for (const PagePlace& place : places_) bytes += place.bytes;
  const std::uint64_t words = (bytes + 7) / 8;
  const std::uint64_t groups = (places_.size() + kGroupPages - 1) / kGroupPages;
  const MemoryReservation counted(memory_, 8 * groups + 2 * places_.size() + 8 * words);
  pages.groups.reserve(groups);
  pages.pages.reserve(places_.size());
  std::uint64_t begin = 0;
  for (std::uint64_t page = 0; page < places_.size(); ++page) {
    pages.add_page(begin);
    begin += places_[page].bytes;
  }
  pages.words.assign(words, 0);
  std::uint64_t at = 0;
  for (const PagePlace& place : places_) {
    const std::uint64_t* from = chunks_[place.chunk].data() + place.word;
    for (int left = 8 * place.bytes; left > 0; left -= 64) {
      const int bits = std::min(left, 64);
      write_bits(pages.words.data(), at, bits, *from++);
      at += static_cast<std::uint64_t>(bits);
    }
  }
  return pages;
}

}  // namespace voxdag
