#pragma once
/// Counts how often a file is opened.
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "voxdag/core/io/descriptor.hpp"

namespace voxdag {

/// Counts how often any process opens a file. Two opens count as one if nobody reads or closes the
/// file in between.
class OpenCount {
 public:
  explicit OpenCount(const std::string& file) : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // The system merges equal events that follow each other: the other events keep opens apart.
    if (inotify_add_watch(events_.get(), file.c_str(), IN_OPEN | IN_CLOSE | IN_ACCESS) < 0)
      ADD_FAILURE() << file << ": " << std::strerror(errno);
  }

  /// Returns the number of opens since the last call.
  int take() {
    int opens = 0;
    alignas(inotify_event) char buffer[1 << 16];
    for (ssize_t got = 0; (got = ::read(events_.get(), buffer, sizeof buffer)) > 0;)
      for (ssize_t at = 0; at < got;) {
        inotify_event event;
        std::memcpy(&event, buffer + at, sizeof event);
        opens += (event.mask & IN_OPEN) != 0;
        at += static_cast<ssize_t>(sizeof event + event.len);
      }
    return opens;
  }

 private:
  Descriptor events_;
};

}  // namespace voxdag
