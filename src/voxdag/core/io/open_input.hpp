#pragma once
/// Opens input files. The library opens every input here, so that all errors have the same form.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

enum class InputKind {
  kRegularFile,
  kFileOrPipe,  ///< A regular file, a pipe or a socket; never a device such as /dev/zero.
};

/// The maximum size of one kind of input.
struct SizeLimit {
  std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  const char* kind = "";  ///< For the error, with its article: "a camera path".
};

/// An input that is open for reading.
struct OpenInput {
  Descriptor descriptor;
  std::optional<std::uint64_t> size;  ///< Bytes of a regular file; none for a pipe.
};

/// Opens a file for reading. With kRegularFile, refuses a named pipe; with kFileOrPipe, waits until
/// the pipe has a writer.
///
/// Throws Error(path, "", reason) with the reason "cannot open: ...", "is a directory", "is not a
/// regular file", "is neither a regular file nor a pipe", or "N bytes are more than the limit of M
/// MiB for KIND".
OpenInput open_input(const std::filesystem::path& path, InputKind kind = InputKind::kRegularFile,
                     SizeLimit limit = {});

/// Reads a whole input of at most `limit.bytes`. Memory: the bytes of the input. Refuses a larger
/// input before it reads more than the limit. Throws the errors of open_input, and "cannot read:
/// ...".
std::string read_input(const std::filesystem::path& path, SizeLimit limit,
                       InputKind kind = InputKind::kRegularFile);

}  // namespace voxdag
