#pragma once
/// Runs code that a hostile file can crash, in a child process that can do nothing but compute.
#include <cstddef>
#include <cstdint>
#include <functional>

#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct ChildLimits {
  std::uint64_t memory = 0;   ///< Bytes that the child may take beyond what this process has.
  std::uint32_t seconds = 0;  ///< Processor time.
};

/// A fork of this process. It sees a copy of this process's memory, but cannot open files, connect,
/// start programs, send signals or make threads: seccomp refuses these system calls. Of the open
/// files it has only the pipe to its parent. It ends with its parent.
class ConfinedChild {
 public:
  /// Starts a child that calls write(bytes, size) with its results, in order. `body` must not use
  /// other threads; what it throws ends the child. Throws Error without a file if the system
  /// refuses to make or to confine the child.
  using Write = std::function<void(const void* bytes, std::size_t size)>;
  ConfinedChild(const ChildLimits& limits, const std::function<void(const Write&)>& body);
  ConfinedChild(const ConfinedChild&) = delete;
  ConfinedChild& operator=(const ConfinedChild&) = delete;
  ~ConfinedChild();  ///< Kills the child.

  /// Waits for the next `size` bytes of the child's results. Throws OverMemory or Error without a
  /// file if the child ended before: it reached a limit or crashed. Throws Cancelled.
  void read(void* bytes, std::size_t size, const Work& work);

 private:
  [[noreturn]] void throw_reason();

  ChildLimits limits_;
  int process_ = -1;
  Descriptor results_;
};

}  // namespace voxdag
