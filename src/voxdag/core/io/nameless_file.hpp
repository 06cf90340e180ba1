#pragma once
/// Files without a name (O_TMPFILE). The system frees them when the process ends, however it ends.
#include <filesystem>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

/// Creates a nameless file in `folder` (empty: the current folder), for reading and writing.
/// Returns its descriptor, or -1 if the file system has no nameless files.
int open_nameless_file(const std::filesystem::path& folder);

/// Opens an empty file in `folder` (empty: the current folder), for reading and writing, that has
/// no name, or loses it at once if the file system has no nameless files. Returns no descriptor,
/// and sets errno, if that fails.
Descriptor open_scratch_file(const std::filesystem::path& folder);

/// Opens an empty file in memory, for reading and writing. A program that this one starts has it
/// only if it `is_inherited`. Returns no descriptor, and sets errno, if that fails.
Descriptor open_memory_file(bool is_inherited = false);

/// Returns the path by which this process opens one of its open files again.
std::filesystem::path path_of_descriptor(int descriptor);

/// Returns another descriptor of the same open file, or none, with errno.
Descriptor duplicate(int descriptor) noexcept;

/// Gives a nameless file a name in the folder that it was created for. Returns 0, or the system's
/// error: EEXIST if the name is taken.
int name_file(int descriptor, const std::filesystem::path& name) noexcept;

/// Copies all bytes and the permissions of a file to an empty one. Returns 0, or the system's
/// error.
int copy_file(int from, int to) noexcept;

/// Exchanges the names of two files or folders, in one step where the system can. Returns 0, or the
/// system's error.
int exchange_names(const std::filesystem::path& a, const std::filesystem::path& b) noexcept;

}  // namespace voxdag
