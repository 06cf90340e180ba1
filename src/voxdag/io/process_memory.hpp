#pragma once
/// The memory that this process has and may take.
#include <cstdint>
#include <filesystem>
#include <optional>

#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Returns the budget of a whole command. Make it before anything is read, then pass it to readers
/// and builders. Its base is what the process holds now. `limit` in bytes; 0:
/// default_memory_limit(). Also makes malloc return freed memory to the system early, so that what
/// is counted is what is resident: for programs, not for libraries.
MemoryBudget command_budget(std::uint64_t limit);

/// Returns three quarters of the memory that the system has available, or of what the process's
/// control groups allow if that is less. 0 (no limit) if the system reports neither.
std::uint64_t default_memory_limit();

/// Returns the least memory limit in bytes of the process's control group (version 1 or 2) and of
/// those above it, if there is one. Reads proc/self/cgroup and sys/fs/cgroup below `root`.
std::optional<std::uint64_t> cgroup_memory_limit(const std::filesystem::path& root = "/");

/// Returns the bytes of memory that the process has resident; 0 if the system does not report it.
std::uint64_t resident_bytes();

/// Returns the largest number of bytes that the process has had resident so far.
std::uint64_t peak_resident_bytes();

}  // namespace voxdag
