#pragma once
/// A file that all ranks write through MPI-IO.
#include <mpi.h>

#include <filesystem>

#include "voxdag/cluster/mpi/mpi_session.hpp"
#include "voxdag/cluster/ranks.hpp"

namespace voxdag {

/// Its errors do not stop the session, so that ranks can tell each other about them. If it is
/// destroyed before close(), it stays open until the process ends, because only all ranks together
/// can close it.
class MpiFile final : public RankFile {
 public:
  /// Opens an existing file. Collective. Writes at most `write_bytes` bytes at once.
  MpiFile(MpiSession& session, const std::filesystem::path& path, std::uint64_t write_bytes);
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) override;
  void close() override;

 private:
  [[noreturn]] void fail(std::uint64_t offset, const std::string& reason) const;

  MpiSession& session_;
  std::filesystem::path path_;
  std::uint64_t write_bytes_;
  MPI_File file_ = MPI_FILE_NULL;
};

}  // namespace voxdag
