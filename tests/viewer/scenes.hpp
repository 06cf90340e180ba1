#pragma once
/// Scenes for tests of the server.
#include <string>

#include "viewer/scene/scene_bytes.hpp"

namespace voxdag {

/// A scene whose bytes are a function of their offsets.
class PatternScene final : public SceneBytes {
 public:
  explicit PatternScene(std::uint64_t size) : size_(size) {}

  std::uint64_t size() const override { return size_; }
  std::string tag() const override { return "0123456789abcdef"; }
  bool is_unchanged() const override { return true; }
  bool read(std::uint64_t offset, std::span<std::byte> out) const override {
    for (std::byte& byte : out) byte = static_cast<std::byte>(at(offset++));
    return true;
  }
  /// Returns the bytes from `first` to `last`.
  std::string text(std::uint64_t first, std::uint64_t last) const {
    std::string text;
    for (std::uint64_t i = first; i <= last; ++i) text += static_cast<char>(at(i));
    return text;
  }

 private:
  static std::uint8_t at(std::uint64_t i) { return static_cast<std::uint8_t>(i * 7 + i / 251); }

  std::uint64_t size_;
};

}  // namespace voxdag
