#pragma once
/// An owned file descriptor.
#include <unistd.h>

#include <utility>

namespace voxdag {

/// Closes the descriptor when destroyed. Move-only; -1 means none.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) noexcept : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }

  int get() const { return value_; }
  bool is_open() const { return value_ >= 0; }
  /// Gives up the descriptor and returns it; the caller must close it.
  int release() noexcept { return std::exchange(value_, -1); }

 private:
  int value_;
};

}  // namespace voxdag
