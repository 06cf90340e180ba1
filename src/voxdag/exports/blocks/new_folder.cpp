#include "voxdag/exports/blocks/new_folder.hpp"

#include <unistd.h>

#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {

namespace fs = std::filesystem;

NewFolder::NewFolder(const fs::path& path)
    : path_(path.has_filename() ? path : path.parent_path()) {
  std::error_code error;
  // The folder that "." or a symbolic link names.
  if (const fs::path canonical = fs::weakly_canonical(path_, error); !error) path_ = canonical;
  if (fs::exists(path_, error) && !(fs::is_directory(path_, error) && fs::is_empty(path_, error)))
    throw Error(path_.string(), "",
                error ? error.message() : "exists and is not an empty folder: choose another name");
  temporary_ = path_.string() + ".voxdag-" + std::to_string(::getpid());
  fs::remove_all(temporary_, error);
  if (!fs::create_directory(temporary_, error))
    throw Error(path_.string(), "", "cannot create: " + error.message());
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void NewFolder::commit() {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw Error(path_.string(), "", "cannot create: " + error.message());
  temporary_.clear();
}

}  // namespace voxdag
