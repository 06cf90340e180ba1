#include "voxdag/formats/imports/points/lzf_stream.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kWindow = 8192;  ///< The longest distance of a copy.
constexpr std::size_t kLongestItem = 264;
constexpr std::size_t kBuffer = kWindow + 65536;

}  // namespace

LzfStream::LzfStream(std::string_view compressed)
    : in_(compressed.data()), in_end_(in_ + compressed.size()), buffer_(kBuffer) {}

void LzfStream::read(char* to, std::size_t size) {
  while (size > 0) {
    if (next_ == decoded_) decode_more();
    const std::size_t part = std::min(size, decoded_ - next_);
    std::memcpy(to, buffer_.data() + next_, part);
    next_ += part;
    to += part;
    size -= part;
  }
}

void LzfStream::skip(std::uint64_t size) {
  while (size > 0) {
    if (next_ == decoded_) decode_more();
    const std::size_t part = std::min<std::uint64_t>(size, decoded_ - next_);
    next_ += part;
    size -= part;
  }
}

void LzfStream::decode_more() {
  if (in_ == in_end_) throw Fault{in_, "the compressed data ends before the last point"};
  const std::size_t kept = std::min(decoded_, kWindow);
  std::memmove(buffer_.data(), buffer_.data() + decoded_ - kept, kept);
  next_ = decoded_ = kept;
  while (in_ != in_end_ && decoded_ + kLongestItem <= buffer_.size()) decode_item();
}

void LzfStream::decode_item() {
  const char* const item = in_;
  const auto byte = [&]() -> std::size_t {
    if (in_ == in_end_) throw Fault{item, "the compressed data ends inside an item"};
    return static_cast<unsigned char>(*in_++);
  };
  const std::size_t control = byte();
  if (control < 32) {
    const std::size_t length = control + 1;
    if (static_cast<std::size_t>(in_end_ - in_) < length)
      throw Fault{item, "the compressed data ends inside an item"};
    std::memcpy(buffer_.data() + decoded_, in_, length);
    in_ += length;
    decoded_ += length;
    return;
  }
  std::size_t length = (control >> 5) + 2;
  if (length == 9) length += byte();
  const std::size_t distance = (control & 31) * 256 + byte() + 1;
  if (distance > decoded_)
    throw Fault{item, "the compressed data copies " + std::to_string(distance) +
                          " bytes back, before its start"};
  // The parts may overlap: then the copy repeats what it wrote.
  for (char* to = buffer_.data() + decoded_; length > 0; --length, ++to, ++decoded_)
    *to = *(to - distance);
}

}  // namespace voxdag
