#include "voxdag/formats/readers/gltf/gltf_value.hpp"

#include <fast_float/fast_float.h>

#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>

namespace voxdag {
namespace {

double to_double(std::string_view number) {
  double value = 0;
  fast_float::from_chars(number.data(), number.data() + number.size(), value);
  return value;
}

}  // namespace

GltfValue GltfValue::operator[](const char* key) const {
  if (exists() && json().kind != JsonKind::kObject) throw error("is not a JSON object");
  GltfValue member = *this;
  const std::uint32_t found = exists() ? document_->member(json(), key) : JsonDocument::kAbsent;
  if (found != JsonDocument::kAbsent) {
    member.node_ = found;
  } else {
    assert(absent_count_ < kMaxAbsent);
    member.absent_[member.absent_count_++] = key;
  }
  return member;
}

GltfItems GltfValue::items() const {
  if (!exists()) return {};
  if (json().kind != JsonKind::kArray) throw error("is not a JSON array");
  return {*source_, *document_, json().first, json().count};
}

std::uint64_t GltfValue::whole(std::uint64_t absent) const { return exists() ? whole() : absent; }

std::uint64_t GltfValue::whole() const {
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 53;
  if (!exists()) throw error("is missing");
  if (json().kind == JsonKind::kNumber) {
    const std::string_view digits = document_->text(json());
    const char* const end = digits.data() + digits.size();
    std::uint64_t number = 0;
    const auto result = std::from_chars(digits.data(), end, number);
    if (result.ec == std::errc() && result.ptr == end && number <= kLimit) return number;
    // Some writers write 3.0 for 3.
    const double real = to_double(digits);
    const bool is_real = digits.find_first_of(".eE") != digits.npos;
    if (is_real && real >= 0 && real <= static_cast<double>(kLimit) && real == std::floor(real))
      return static_cast<std::uint64_t>(real);
  }
  throw error("is not a whole number of 0 or more");
}

bool GltfValue::boolean(bool absent) const {
  if (!exists()) return absent;
  if (json().kind != JsonKind::kTrue && json().kind != JsonKind::kFalse)
    throw error("is neither true nor false");
  return json().kind == JsonKind::kTrue;
}

std::string_view GltfValue::text_view(std::string& unescaped) const {
  if (!exists()) return {};
  if (json().kind != JsonKind::kString) throw error("is not a string");
  const std::string_view text = document_->text(json());
  if (text.find('\\') == text.npos) return text;
  const MemoryReservation memory(source_->work().memory, text.size());
  unescaped = unescape_json(text);
  return unescaped;
}

std::string GltfValue::text(const std::string& absent) const {
  if (!exists()) return absent;
  std::string unescaped;
  return std::string(text_view(unescaped));
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  if (!exists()) return {};
  std::vector<double> numbers;
  if (json().kind == JsonKind::kArray && json().count == count)
    for (const GltfValue item : items())
      if (item.json().kind == JsonKind::kNumber)
        numbers.push_back(to_double(document_->text(item.json())));
  if (json().kind != JsonKind::kArray || numbers.size() != count || json().count != count)
    throw error("is not an array of " + std::to_string(count) + " numbers");
  return numbers;
}

double GltfValue::number(double absent) const {
  if (!exists()) return absent;
  if (json().kind != JsonKind::kNumber) throw error("is not a number");
  return to_double(document_->text(json()));
}

std::string GltfValue::path() const {
  std::string path = document_->path(node_);
  for (std::uint32_t i = 0; i < absent_count_; ++i) {
    if (!path.empty()) path += '.';
    path += absent_[i];
  }
  return path;
}

}  // namespace voxdag
