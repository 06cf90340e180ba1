#include "voxdag/core/io/temporary_folder.hpp"

#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/nameless_file.hpp"
#include "voxdag/core/io/temporary_file.hpp"

namespace voxdag {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what,
                       const std::error_code& error) {
  throw Error(path.string(), "", what + ": " + error.message());
}

}  // namespace

TemporaryFolder::TemporaryFolder(const fs::path& target)
    : target_(target), path_(temporary_name(target)) {
  std::error_code error;
  if (!fs::create_directory(path_, error)) fail(target_, "cannot create", error);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void TemporaryFolder::take_name() const {
  std::error_code error;
  if (fs::exists(target_, error)) {
    // After the exchange, the destructor removes the old folder.
    if (const int code = exchange_names(path_, target_); code != 0)
      fail(target_, "cannot replace", std::error_code(code, std::system_category()));
    return;
  }
  fs::rename(path_, target_, error);
  if (error) fail(target_, "cannot create", error);
}

}  // namespace voxdag
