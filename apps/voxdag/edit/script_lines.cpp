#include "edit/script_lines.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/open_input.hpp"

namespace voxdag::cli {

ScriptLines::ScriptLines(const std::string& file)
    : file_(file),
      input_(file == "-" ? Descriptor(::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0))
                         : std::move(open_input(file, InputKind::kFileOrPipe).descriptor)) {
  if (!input_.is_open())
    throw Error(file_, "", std::string("cannot open: ") + std::strerror(errno));
}

bool ScriptLines::next(std::string_view& line) {
  constexpr std::size_t kLongest = std::size_t{256} << 20;
  std::size_t end = buffer_.find('\n', start_);
  while (end == buffer_.npos) {
    buffer_.erase(0, start_);
    start_ = 0;
    const std::size_t searched = buffer_.size();
    if (searched > kLongest)
      throw Error(file_, ErrorPlace::line(number_ + 1), "is longer than 256 MiB");
    if (!read_more()) {
      if (buffer_.empty()) return false;
      end = searched;
      break;
    }
    end = buffer_.find('\n', searched);
  }
  line = std::string_view(buffer_).substr(start_, end - start_);
  start_ = std::min(end + 1, buffer_.size());
  ++number_;
  return true;
}

bool ScriptLines::read_more() {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  const std::size_t before = buffer_.size();
  buffer_.resize(before + kChunk);
  ssize_t count = 0;
  do count = ::read(input_.get(), buffer_.data() + before, kChunk);
  while (count < 0 && errno == EINTR);
  buffer_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (count < 0) throw Error(file_, "", std::string("cannot read: ") + std::strerror(errno));
  return count > 0;
}

}  // namespace voxdag::cli
