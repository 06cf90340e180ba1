#pragma once
/// The memory that this process uses and may use.
#include <cstdint>
#include <filesystem>
#include <optional>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns the budget of a whole command. Call it before anything is read, then pass the budget to
/// readers and builders. Its base is the memory that the process holds now. `limit` is in bytes; 0
/// means default_memory_limit(). Also makes malloc return freed memory to the system early, so that
/// the counted memory is the resident memory. For programs, not for libraries.
MemoryBudget command_budget(std::uint64_t limit);

/// Returns three quarters of the memory that the system has available, or three quarters of the
/// limit of the process's control groups if that is less. 0 (no limit) if the system reports
/// neither.
std::uint64_t default_memory_limit();

/// Returns the least memory limit, in bytes, of the process's control group (version 1 or 2) and
/// its ancestors, or nothing if none has a limit. Reads proc/self/cgroup and sys/fs/cgroup below
/// `root`.
std::optional<std::uint64_t> cgroup_memory_limit(const std::filesystem::path& root = "/");

/// Returns the resident memory of the process in bytes; 0 if the system does not report it.
std::uint64_t resident_bytes();

/// Returns the peak of resident_bytes() so far.
std::uint64_t peak_resident_bytes();

}  // namespace voxdag
