#pragma once
/// XXH3-64 (Yann Collet's xxHash), seed 0, of a run of bytes.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace voxdag {

std::uint64_t xxh3_64(std::span<const std::byte> bytes);

/// The same of bytes that come piece by piece.
class Xxh3Stream {
 public:
  Xxh3Stream();
  ~Xxh3Stream();
  Xxh3Stream(Xxh3Stream&&) noexcept;
  Xxh3Stream& operator=(Xxh3Stream&&) = delete;

  void add(std::span<const std::byte> bytes);
  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace voxdag
