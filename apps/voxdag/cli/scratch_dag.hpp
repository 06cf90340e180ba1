#pragma once
/// A DAG that a command builds for another one, in a file without a name.
#include <string>

#include "cli/session.hpp"
#include "voxdag/core/io/descriptor.hpp"

namespace voxdag::cli {

/// A file in the folder for temporary files (TMPDIR, else /tmp). It has no name, so that the system
/// frees it however the process ends. Messages of the session call it `name`. Only one per session.
class ScratchDag {
 public:
  /// Throws Error if the folder takes no file.
  ScratchDag(const std::string& name, Session& session);

  /// Returns a path that writes and opens the file as long as this object lives.
  const std::string& path() const { return path_; }

 private:
  Descriptor file_;
  std::string path_;
};

}  // namespace voxdag::cli
