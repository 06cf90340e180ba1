#include "voxdag/voxels/sorted_codes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <queue>
#include <string>
#include <system_error>

#include "voxdag/core/error.hpp"
#include "voxdag/io/nameless_file.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/parallel/polled_sort.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kLeastCapacity = 1024;

/// Codes of a run in memory at a time.
constexpr std::size_t kReadCodes = std::size_t{1} << 15;

[[noreturn]] void fail(const std::filesystem::path& folder, const char* what) {
  throw Error(folder.string(), "",
              std::string("cannot ") + what +
                  " a file for sorting: " + std::system_category().message(errno));
}

/// Makes a file without a name.
Descriptor make_file(const std::filesystem::path& folder) {
  if (const int nameless = open_nameless_file(folder); nameless >= 0) return Descriptor(nameless);
  std::string name = (folder / ".voxdag-sort-XXXXXX").string();
  Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
  if (!file.is_open()) fail(folder, "create");
  ::unlink(name.c_str());
  return file;
}

}  // namespace

/// Reads a run from its beginning.
class SortedCodes::RunReader {
 public:
  RunReader(const Run& run, const std::filesystem::path& folder) : run_(run), folder_(folder) {
    read();
  }
  bool is_at_end() const { return at_ == codes_.size(); }
  std::uint64_t code() const { return codes_[at_]; }
  void next() {
    if (++at_ == codes_.size()) read();
  }

 private:
  void read() {
    at_ = 0;
    codes_.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kReadCodes, run_.codes - done_)));
    auto* bytes = reinterpret_cast<char*>(codes_.data());
    std::size_t left = codes_.size() * sizeof(std::uint64_t);
    auto offset = static_cast<off_t>(done_ * sizeof(std::uint64_t));
    while (left > 0) {
      const ssize_t got = ::pread(run_.file.get(), bytes, left, offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) fail(folder_, "read");
      bytes += got;
      offset += got;
      left -= static_cast<std::size_t>(got);
    }
    done_ += codes_.size();
  }

  const Run& run_;
  const std::filesystem::path& folder_;
  std::vector<std::uint64_t> codes_;
  std::size_t at_ = 0;
  std::uint64_t done_ = 0;
};

SortedCodes::SortedCodes(std::size_t capacity, std::filesystem::path folder, MemoryBudget* memory,
                         Progress* progress)
    : capacity_(std::max(capacity, kLeastCapacity)),
      folder_(std::move(folder)),
      progress_(progress),
      codes_(memory) {}

void SortedCodes::sort_in_memory() {
  polled_sort(codes_.begin(), codes_.end(), progress_);
  codes_.resize(
      static_cast<std::size_t>(std::unique(codes_.begin(), codes_.end()) - codes_.begin()));
}

void SortedCodes::spill() {
  sort_in_memory();
  // Many equal codes may have made room.
  if (codes_.size() <= capacity_ / 2) return;
  Run run{make_file(folder_), codes_.size()};
  const auto* bytes = reinterpret_cast<const char*>(codes_.begin());
  std::size_t left = codes_.size() * sizeof(std::uint64_t);
  while (left > 0) {
    const ssize_t put = ::write(run.file.get(), bytes, std::min<std::size_t>(left, 1 << 24));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail(folder_, "write");
    poll(progress_);
    bytes += put;
    left -= static_cast<std::size_t>(put);
  }
  runs_.push_back(std::move(run));
  codes_.resize(0);
}

void SortedCodes::visit_all(const std::function<void(std::uint64_t)>& visit) {
  sort_in_memory();
  if (runs_.empty()) {
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      poll_seldom(progress_, i);
      visit(codes_[i]);
    }
    return;
  }
  std::vector<RunReader> readers;
  readers.reserve(runs_.size());
  for (const Run& run : runs_) readers.emplace_back(run, folder_);
  // The least code of each run, and at the end of `readers` that in memory.
  using Head = std::pair<std::uint64_t, std::size_t>;
  std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
  for (std::size_t i = 0; i < readers.size(); ++i) heads.emplace(readers[i].code(), i);
  std::size_t in_memory = 0;
  if (codes_.size() > 0) heads.emplace(codes_[0], readers.size());
  bool is_first = true;
  std::uint64_t last = 0, polled = 0;
  while (!heads.empty()) {
    poll_seldom(progress_, polled++);
    const auto [code, source] = heads.top();
    heads.pop();
    if (is_first || code != last) visit(code);
    is_first = false;
    last = code;
    if (source < readers.size()) {
      readers[source].next();
      if (!readers[source].is_at_end()) heads.emplace(readers[source].code(), source);
    } else if (++in_memory < codes_.size()) {
      heads.emplace(codes_[in_memory], source);
    }
  }
}

}  // namespace voxdag
