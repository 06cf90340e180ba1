#include "voxdag/cluster/work_file.hpp"

#include <algorithm>
#include <cstring>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

struct WorkFileHeader {
  char magic[8] = {'V', 'D', 'A', 'G', 'W', 'O', 'R', 'K'};
  std::uint64_t key = 0, bytes = 0, checksum = 0;
  std::uint64_t reserved[4] = {};
};
static_assert(sizeof(WorkFileHeader) == 64);

}  // namespace

WorkFileWriter::WorkFileWriter(const std::filesystem::path& path, std::uint64_t key,
                               std::size_t buffer_bytes)
    : file_(path, 0), key_(key), buffer_bytes_(buffer_bytes) {
  const WorkFileHeader header;
  file_.write(&header, sizeof header);
}

void WorkFileWriter::write(std::span<const std::byte> bytes) {
  if (buffer_.size() + bytes.size() > buffer_bytes_) flush();
  if (bytes.size() > buffer_bytes_) return pass_on(bytes);
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

void WorkFileWriter::pass_on(std::span<const std::byte> bytes) {
  file_.write(bytes);
  checksum_.add(bytes);
  written_ += bytes.size();
}

void WorkFileWriter::flush() {
  if (!buffer_.empty()) pass_on(buffer_);
  buffer_.clear();
}

void WorkFileWriter::commit() {
  flush();
  WorkFileHeader header;
  header.key = key_;
  header.bytes = written_;
  header.checksum = checksum_.digest();
  file_.overwrite(0, &header, sizeof header);
  file_.commit();
}

std::optional<WorkFile> WorkFile::open(const std::filesystem::path& path, std::uint64_t key,
                                       Work work, Check check) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return std::nullopt;
  WorkFile file(MappedFile(path, MappedFile::Access::kSequential));
  const std::span<const std::byte> all = file.file_.bytes();
  WorkFileHeader header;
  if (all.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, all.data(), sizeof header);
  if (std::memcmp(header.magic, WorkFileHeader{}.magic, sizeof header.magic) != 0 ||
      header.key != key || header.bytes != all.size() - sizeof header)
    return std::nullopt;
  if (check == Check::kHeader) return file;
  constexpr std::size_t kBytesPerStep = std::size_t{16} << 20;
  Xxh3Stream checksum;
  const std::span<const std::byte> contents = file.bytes();
  for (std::size_t at = 0; at < contents.size(); at += kBytesPerStep) {
    work.poll();
    checksum.add(contents.subspan(at, std::min(kBytesPerStep, contents.size() - at)));
    if (contents.size() > kBytesPerStep) file.release(at + kBytesPerStep);
  }
  if (checksum.digest() != header.checksum) return std::nullopt;
  return file;
}

std::span<const std::byte> WorkFile::bytes() const {
  return file_.bytes().subspan(sizeof(WorkFileHeader));
}

void WorkFile::release(std::size_t end) const {
  file_.release(file_.text().substr(0, sizeof(WorkFileHeader) + end));
}

}  // namespace voxdag
