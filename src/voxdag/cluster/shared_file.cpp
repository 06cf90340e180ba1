#include "voxdag/cluster/shared_file.hpp"

#include <cassert>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Calls `work` on this rank. If it throws an Error on any rank, all ranks throw. Collective.
template <class Work>
void together(Ranks& ranks, const std::filesystem::path& path, const Work& work) {
  std::exception_ptr error;
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& failure) {
    error = std::make_exception_ptr(failure.in_file(path.string()));
  }
  const std::uint64_t mine = error != nullptr ? 1 : 0;
  const std::vector<std::uint64_t> failed = ranks.all_gather({&mine, 1});
  if (error != nullptr) std::rethrow_exception(error);
  for (std::size_t rank = 0; rank < failed.size(); ++rank)
    if (failed[rank] != 0)
      throw Error(path.string(), "", "cannot write: rank " + std::to_string(rank) + " failed");
}

}  // namespace

SharedFile::SharedFile(Ranks& ranks, const std::filesystem::path& path, std::uint64_t bytes)
    : ranks_(ranks), path_(path), bytes_(bytes) {
  std::vector<std::byte> name;
  together(ranks, path, [&] {
    if (ranks.rank() != 0) return;
    output_ = std::make_unique<NamedOutput>(path, bytes);
    const std::string text = output_->temporary().string();
    name.resize(text.size());
    std::memcpy(name.data(), text.data(), text.size());
  });
  ranks.broadcast(name);
  const std::string text(reinterpret_cast<const char*>(name.data()), name.size());
  together(ranks, path, [&] { file_ = ranks.open_file(text); });
}

void SharedFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  assert(file_ != nullptr && offset <= bytes_ && bytes.size() <= bytes_ - offset);
  try {
    file_->write_at(offset, bytes);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw error.in_file(path_.string());
  }
}

void SharedFile::commit() {
  assert(file_ != nullptr);
  together(ranks_, path_, [&] { file_->close(); });
  file_.reset();
  together(ranks_, path_, [&] {
    if (output_ != nullptr) output_->publish();
  });
}

}  // namespace voxdag
