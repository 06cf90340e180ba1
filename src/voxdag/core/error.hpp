#pragma once
/// The one exception of the library.
#include <stdexcept>
#include <string>
#include <utility>

namespace voxdag {

/// Bad input or a failed resource. `what()` is one line: "FILE: PLACE: REASON", empty parts left
/// out. The library throws it and never prints; the command line reports it and exits with 1.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& reason) : std::runtime_error(reason), reason_(reason) {}

  /// `place` says where in the file: "line 12", "byte 84", "chunk NODE".
  Error(std::string file, std::string place, std::string reason)
      : std::runtime_error(join(file, place, reason)),
        file_(std::move(file)),
        place_(std::move(place)),
        reason_(std::move(reason)) {}

  const std::string& file() const { return file_; }
  const std::string& place() const { return place_; }
  const std::string& reason() const { return reason_; }

 private:
  static std::string join(const std::string& file, const std::string& place,
                          const std::string& reason) {
    std::string line;
    for (const std::string* part : {&file, &place})
      if (!part->empty()) line += *part + ": ";
    return line + reason;
  }

  std::string file_, place_, reason_;
};

/// Thrown by long work that its caller cancelled (Ctrl-C).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace voxdag
