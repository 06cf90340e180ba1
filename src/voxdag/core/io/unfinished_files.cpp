#include "voxdag/core/io/unfinished_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <iterator>

namespace voxdag {
namespace {

/// The thread or handler that takes a name out of its slot owns the name.
std::atomic<char*> unfinished[64];
/// Names of removed files. A signal handler must not free them.
char* removed[std::size(unfinished)];

}  // namespace

char* note_unfinished(const std::filesystem::path& name) {
  char* copy = ::strdup(name.c_str());
  if (copy == nullptr) return nullptr;
  for (auto& slot : unfinished) {
    char* free_slot = nullptr;
    if (slot.compare_exchange_strong(free_slot, copy)) return copy;
  }
  std::free(copy);
  return nullptr;
}

bool is_noted(const char* name) {
  return std::any_of(std::begin(unfinished), std::end(unfinished),
                     [name](const auto& slot) { return slot.load() == name; });
}

void forget_unfinished(char* name) noexcept {
  if (name == nullptr) return;
  for (auto& slot : unfinished) {
    char* expected = name;
    if (slot.compare_exchange_strong(expected, nullptr)) return std::free(name);
  }
}

void remove_unfinished_files() noexcept {
  for (std::size_t i = 0; i < std::size(unfinished); ++i)
    if (char* const name = unfinished[i].exchange(nullptr)) {
      ::unlink(name);
      removed[i] = name;
    }
}

}  // namespace voxdag
