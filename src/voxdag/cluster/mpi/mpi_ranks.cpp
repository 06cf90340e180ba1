#include "voxdag/cluster/mpi/mpi_ranks.hpp"

#include <algorithm>
#include <cassert>
#include <exception>
#include <limits>
#include <utility>

#include "voxdag/cluster/mpi/mpi_module.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// A file that all ranks write through MPI-IO. Its errors do not stop the session, so that ranks
/// can tell each other about them. If it is destroyed before close(), it stays open until the
/// process ends, because only all ranks together can close it.
class MpiFile final : public RankFile {
 public:
  /// Opens an existing file. Collective. Writes at most `write_bytes` bytes at once.
  MpiFile(MpiSession& session, const std::filesystem::path& path, std::uint64_t write_bytes)
      : session_(session), path_(path), write_bytes_(write_bytes) {
    // MPI_File_open waits for all ranks, and cannot be cancelled. After a barrier the wait is
    // short.
    session.barrier();
    const int code = session.call([&] {
      return MPI_File_open(session.comm(), path_.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file_);
    });
    if (code != MPI_SUCCESS) fail(0, "cannot open: " + session_.error_text(code));
  }

  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const std::size_t now = std::min<std::uint64_t>(bytes.size(), write_bytes_);
      int written = 0;
      const int code = session_.call([&] {
        MPI_Status status;
        const int error = MPI_File_write_at(file_, static_cast<MPI_Offset>(offset), bytes.data(),
                                            static_cast<int>(now), MPI_BYTE, &status);
        return error != MPI_SUCCESS ? error : MPI_Get_count(&status, MPI_BYTE, &written);
      });
      if (code != MPI_SUCCESS) fail(offset, "cannot write: " + session_.error_text(code));
      if (written <= 0) fail(offset, "cannot write: MPI wrote no bytes; is the disk full?");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    }
  }

  void close() override {
    session_.barrier();
    const int code = session_.call([&] { return MPI_File_close(&file_); });
    if (code != MPI_SUCCESS) fail(0, "cannot write: " + session_.error_text(code));
  }

 private:
  [[noreturn]] void fail(std::uint64_t offset, const std::string& reason) const {
    throw Error(path_.string(), ErrorPlace::byte(offset), reason);
  }

  MpiSession& session_;
  std::filesystem::path path_;
  std::uint64_t write_bytes_;
  MPI_File file_ = MPI_FILE_NULL;
};

constexpr int kExchangeTag = 1;

/// Calls message(address, bytes) for parts of `bytes` of at most `most` bytes.
template <class Message>
void for_each_message(std::byte* bytes, std::size_t count, std::size_t most,
                      const Message& message) {
  for (std::size_t done = 0; done < count; done += most)
    message(bytes + done, static_cast<int>(std::min(most, count - done)));
}

}  // namespace

MpiRanks::MpiRanks(Work work, const RankOptions& options)
    : message_bytes_(options.message_bytes),
      exceptions_(std::uncaught_exceptions()),
      session_(work),
      counters_(session_, kCounters + 1) {}

MpiRanks::~MpiRanks() {
  if (std::uncaught_exceptions() > exceptions_) session_.stop();
  try {
    session_.barrier();
    counters_.close();
    session_.finalize();
  } catch (const Error&) {
    // The job has failed, and MPI cannot end in order. The launcher ends the other ranks.
    session_.stop();
  }
}

std::vector<std::uint64_t> MpiRanks::all_gather(std::span<const std::uint64_t> values) {
  assert(values.size() <= std::size_t{std::numeric_limits<int>::max()});
  const int size = static_cast<int>(values.size());
  std::vector<std::uint64_t> all(values.size() * count());
  MPI_Request request = MPI_REQUEST_NULL;
  session_.run("MPI_Iallgather", [&] {
    return MPI_Iallgather(values.data(), size, MPI_UINT64_T, all.data(), size, MPI_UINT64_T,
                          session_.comm(), &request);
  });
  session_.wait(request, "MPI_Iallgather");
  bytes_sent_ += values.size_bytes() * (count() - 1);
  return all;
}

void MpiRanks::broadcast(std::vector<std::byte>& bytes) {
  std::uint64_t size = bytes.size();
  broadcast_from_0(&size, sizeof size);
  bytes.resize(size);
  broadcast_from_0(bytes.data(), size);
}

void MpiRanks::broadcast_from_0(void* bytes, std::size_t size) {
  for_each_message(static_cast<std::byte*>(bytes), size, message_bytes_,
                   [&](std::byte* part, int part_bytes) {
                     MPI_Request request = MPI_REQUEST_NULL;
                     session_.run("MPI_Ibcast", [&] {
                       return MPI_Ibcast(part, part_bytes, MPI_BYTE, 0, session_.comm(), &request);
                     });
                     session_.wait(request, "MPI_Ibcast", MpiSession::kTransferSleep);
                   });
  if (rank() == 0) bytes_sent_ += size * (count() - 1);
}

/// Messages go directly between the vectors of the sender and the receiver. MPI_Ialltoallv would
/// need all of them in one buffer, and has 32-bit offsets in it.
std::vector<std::vector<std::byte>> MpiRanks::exchange(
    std::vector<std::vector<std::byte>> outgoing) {
  assert(outgoing.size() == static_cast<std::size_t>(count()));
  const std::vector<std::uint64_t> sizes = exchange_sizes(outgoing);
  std::vector<std::vector<std::byte>> incoming(count());
  std::vector<MPI_Request> requests;
  // Rank r begins with rank r + 1, so that not all ranks send to one at once.
  for (int step = 1; step < count(); ++step) {
    const int from = (rank() + count() - step) % count();
    incoming[from].resize(sizes[from]);
    for_each_message(incoming[from].data(), sizes[from], message_bytes_,
                     [&](std::byte* part, int part_bytes) {
                       session_.run("MPI_Irecv", [&] {
                         return MPI_Irecv(part, part_bytes, MPI_BYTE, from, kExchangeTag,
                                          session_.comm(), &requests.emplace_back());
                       });
                     });
  }
  for (int step = 1; step < count(); ++step) {
    const int to = (rank() + step) % count();
    for_each_message(outgoing[to].data(), outgoing[to].size(), message_bytes_,
                     [&](std::byte* part, int part_bytes) {
                       session_.run("MPI_Isend", [&] {
                         return MPI_Isend(part, part_bytes, MPI_BYTE, to, kExchangeTag,
                                          session_.comm(), &requests.emplace_back());
                       });
                     });
    bytes_sent_ += outgoing[to].size();
  }
  session_.wait_all(requests, "MPI_Isend and MPI_Irecv");
  incoming[rank()] = std::move(outgoing[rank()]);
  return incoming;
}

/// Returns how many bytes each rank is to send here.
std::vector<std::uint64_t> MpiRanks::exchange_sizes(
    const std::vector<std::vector<std::byte>>& outgoing) {
  std::vector<std::uint64_t> mine, theirs(outgoing.size());
  for (const std::vector<std::byte>& bytes : outgoing) mine.push_back(bytes.size());
  MPI_Request request = MPI_REQUEST_NULL;
  session_.run("MPI_Ialltoall", [&] {
    return MPI_Ialltoall(mine.data(), 1, MPI_UINT64_T, theirs.data(), 1, MPI_UINT64_T,
                         session_.comm(), &request);
  });
  session_.wait(request, "MPI_Ialltoall");
  return theirs;
}

std::uint64_t MpiRanks::next(int counter) {
  assert(counter >= 0 && counter < kCounters);
  return counters_.next(counter);
}

void MpiRanks::reset(int counter) {
  assert(counter >= 0 && counter < kCounters);
  session_.barrier();
  if (rank() == 0) counters_.set_zero(counter);
  session_.barrier();
}

std::unique_ptr<RankFile> MpiRanks::open_file(const std::filesystem::path& path) {
  return std::make_unique<MpiFile>(session_, path, message_bytes_);
}

}  // namespace voxdag

// NOLINTNEXTLINE(readability-identifier-naming): kMpiModuleName
extern "C" const voxdag::MpiModule voxdag_mpi_module = {
    [](voxdag::Work work, const voxdag::RankOptions& options) -> voxdag::Ranks* {
      return new voxdag::MpiRanks(work, options);
    }};
