#include "cli/scratch_dag.hpp"

#include <fcntl.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/nameless_file.hpp"

namespace voxdag::cli {

ScratchDag::ScratchDag(const std::string& name, Session& session) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  file_ = open_scratch_file(folder);
  // AtomicFile writes to no descriptor that programs do not inherit.
  if (!file_.is_open() || fcntl(file_.get(), F_SETFD, 0) != 0)
    throw Error(folder.string(), "", "no temporary file: " + std::system_category().message(errno));
  path_ = path_of_descriptor(file_.get()).string();
  session.scratch = path_;
  session.scratch_name = name;
}

}  // namespace voxdag::cli
