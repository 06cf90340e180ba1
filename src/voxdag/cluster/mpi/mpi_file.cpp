#include "voxdag/cluster/mpi/mpi_file.hpp"

#include <algorithm>

#include "voxdag/core/error.hpp"

namespace voxdag {

MpiFile::MpiFile(MpiSession& session, const std::filesystem::path& path, std::uint64_t write_bytes)
    : session_(session), path_(path), write_bytes_(write_bytes) {
  // MPI_File_open waits for all ranks, and cannot be cancelled. After a barrier the wait is short.
  session.barrier();
  const int code = session.call([&] {
    return MPI_File_open(session.comm(), path_.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file_);
  });
  if (code != MPI_SUCCESS) fail(0, "cannot open: " + session_.error_text(code));
}

void MpiFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
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

void MpiFile::close() {
  session_.barrier();
  const int code = session_.call([&] { return MPI_File_close(&file_); });
  if (code != MPI_SUCCESS) fail(0, "cannot write: " + session_.error_text(code));
}

void MpiFile::fail(std::uint64_t offset, const std::string& reason) const {
  throw Error(path_.string(), ErrorPlace::byte(offset), reason);
}

}  // namespace voxdag
