#include <gtest/gtest.h>

#include <fstream>
#include <span>

#include "rooms.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

const fs::path kRepository = VOXDAG_SOURCE_DIR;

/// Calls and headers that Linux has and other POSIX systems lack.
constexpr const char* kLinuxAlone[] = {
    "\"/proc/",        "<linux/",         "<malloc.h>",       "<sys/epoll.h>",   "<sys/inotify.h>",
    "<sys/prctl.h>",   "<sys/random.h>",  "<sys/sendfile.h>", "<sys/syscall.h>", "MADV_DONTFORK",
    "MADV_HUGEPAGE",   "MAP_NORESERVE",   "O_TMPFILE",        "SOCK_CLOEXEC",    "accept4(",
    "copy_file_range", "memfd_create(",   "mremap(",          "pipe2(",          "posix_fallocate(",
    "renameat2(",      "sched_getaffini", "sched_setaffini"};

/// Functions that C libraries round in different ways, as glibc does on different processors.
constexpr const char* kInexact[] = {"std::sin(",  "std::cos(",  "std::tan(",   "std::asin(",
                                    "std::acos(", "std::atan(", "std::atan2(", "std::hypot(",
                                    "std::cbrt(", "std::sinh(", "std::cosh(",  "std::tanh("};

/// Returns the sources below `folder` whose code, without its comments, has one of the words:
/// paths that are relative to the repository.
std::set<std::string> sources_with(std::span<const char* const> words, const fs::path& folder) {
  std::set<std::string> sources;
  for (const auto& entry : fs::recursive_directory_iterator(kRepository / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".cpp" && extension != ".hpp" && extension != ".cu") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      line.resize(std::min(line.size(), line.find("//")));
      for (const char* word : words)
        if (line.find(word) != line.npos)
          sources.insert(entry.path().lexically_relative(kRepository).string());
    }
  }
  return sources;
}

TEST(SystemCalls, OnlyCoreCallsLinuxAlone) {
  for (const char* folder : {"src/voxdag", "apps", "python/src"})
    for (const std::string& caller : sources_with(kLinuxAlone, folder))
      EXPECT_TRUE(caller.starts_with("src/voxdag/core/"))
          << caller << ": put the call into src/voxdag/core/io/linux, behind a header of core/io";
}

TEST(SystemCalls, HackingListsTheCallersOfLinux) {
  const std::string page = read_text(kRepository / "HACKING.md");
  const std::set<std::string> callers = sources_with(kLinuxAlone, "src/voxdag/core");
  EXPECT_TRUE(callers.contains("src/voxdag/core/io/linux/pages.cpp"));
  for (const std::string& caller : callers) {
    if (caller.starts_with("src/voxdag/core/io/browser/")) continue;  // emscripten has a /proc
    EXPECT_NE(page.find("| `" + caller.substr(std::string("src/voxdag/").size()) + "` |"),
              page.npos)
        << "HACKING.md, Other systems: add the line of " << caller;
  }
}

TEST(SystemCalls, OnlyPicturesUseTheAnglesOfTheCLibrary) {
  const fs::path library = "src/voxdag";
  for (const fs::directory_entry& room : fs::directory_iterator(kRepository / library)) {
    const std::string name = room.path().filename();
    if (!room.is_directory() || name == "render" || name == "mesh_view") continue;
    for (const std::string& source : sources_with(kInexact, library / name))
      ADD_FAILURE() << source << ": use core/angles.hpp, whose bits are equal on every machine";
  }
}

}  // namespace
}  // namespace voxdag
