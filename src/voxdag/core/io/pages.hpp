#pragma once
/// Memory in whole pages of the system. core/io/linux maps the pages; a browser cannot map any, so
/// core/io/browser allocates them.
#include <cstddef>
#include <cstdint>

namespace voxdag {

inline constexpr std::size_t kPage = 4096, kHugePage = std::size_t{2} << 20;

/// Returns `bytes` zero bytes, aligned to kPage, or null if there are none. `bytes` is a multiple
/// of kPage. The bytes are resident only where they were touched. With `may_be_huge`, many bytes
/// are aligned to kHugePage and lie in huge pages, if the system grants them.
void* map_pages(std::size_t bytes, bool may_be_huge = false) noexcept;

/// Returns how many bytes to map for an array that has `bytes` bytes, grows to at most `most`, and
/// must not move: `most`, because pages cost nothing until they are touched; in a browser, where
/// they cost memory at once, a part of it.
std::uint64_t bytes_to_map(std::uint64_t bytes, std::uint64_t most) noexcept;

/// Resizes an array of pages, and may move it: its old and its new memory need not exist at the
/// same time. New bytes are zero. Returns null, and changes nothing, if there is no memory.
void* resize_pages(void* pages, std::size_t old_bytes, std::size_t new_bytes) noexcept;

/// Gives the pages after the first `new_bytes` back to the system, without moving the others.
/// Returns false if the system cannot.
bool shrink_pages(void* pages, std::size_t old_bytes, std::size_t new_bytes) noexcept;

/// Gives pages back to the system.
void unmap_pages(void* pages, std::size_t bytes) noexcept;

/// Gives the memory back to the system; the bytes become zero. Other threads may read them
/// meanwhile, and see old values or zeros.
void discard_pages(void* pages, std::size_t bytes) noexcept;

}  // namespace voxdag
