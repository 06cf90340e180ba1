#pragma once
/// The one exception type of the library.
#include <stdexcept>
#include <string>
#include <utility>

#include "voxdag/core/error_place.hpp"

namespace voxdag {

/// Bad input or a failed resource. `what()` is one line: "FILE: PLACE: REASON"; empty parts are
/// left out. The library throws it and never prints; the command line reports it and exits with 1.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& reason) : std::runtime_error(reason), reason_(reason) {}

  Error(std::string file, ErrorPlace place, std::string reason)
      : std::runtime_error(join(file, place.text(), reason)),
        file_(std::move(file)),
        place_(std::move(place)),
        reason_(std::move(reason)) {}

  const std::string& file() const { return file_; }
  const ErrorPlace& place() const { return place_; }
  const std::string& reason() const { return reason_; }

  /// Returns a copy of this error whose file name is `file`.
  Error in_file(std::string file) const { return {std::move(file), place_, reason_}; }
  /// Returns a copy of this error whose place is within `outer`: "OUTER, PLACE".
  Error within(ErrorPlace outer) const { return {file_, std::move(outer) / place_, reason_}; }

 private:
  static std::string join(const std::string& file, const std::string& place,
                          const std::string& reason) {
    std::string line;
    for (const std::string* part : {&file, &place})
      if (!part->empty()) line += *part + ": ";
    return line + reason;
  }

  std::string file_;
  ErrorPlace place_;
  std::string reason_;
};

/// Throws Error for a place of a file whose name the caller adds.
[[noreturn]] inline void fail_at(ErrorPlace place, const std::string& reason) {
  throw Error("", std::move(place), reason);
}

/// Thrown by long work that its caller cancelled (Ctrl-C).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace voxdag
