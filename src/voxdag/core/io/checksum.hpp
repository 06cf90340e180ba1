#pragma once
/// Checksums: XXH3-64 (Yann Collet's xxHash) with seed 0.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace voxdag {

/// Returns the checksum of the bytes.
std::uint64_t xxh3_64(std::span<const std::byte> bytes);

/// Computes the checksum of bytes that arrive piece by piece.
class Xxh3Stream {
 public:
  Xxh3Stream();
  ~Xxh3Stream();
  Xxh3Stream(Xxh3Stream&&) noexcept;
  Xxh3Stream& operator=(Xxh3Stream&&) = delete;

  void add(std::span<const std::byte> bytes);
  /// Returns the checksum of all bytes added so far.
  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace voxdag
