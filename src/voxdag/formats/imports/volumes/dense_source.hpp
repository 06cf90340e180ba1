#pragma once
/// Files that hold a dense volume.
#include <string>
#include <vector>

#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {

/// How numbers are written in a file.
enum class Encoding : std::uint8_t {
  kRaw,
  kGzip,
  kAscii,   ///< Decimal numbers between white space.
  kHex,     ///< Two digits a byte; white space is ignored.
  kPlanar,  ///< Raw, but all values of the first channel are followed by all of the second.
  kSlices,  ///< DenseFile::read_slice decodes them one at a time.
};

/// A file with a dense volume, as the parser of its header describes it.
struct DenseFile {
  DenseVolume volume = {};
  VolumeMap map = VolumeMap{};
  bool has_place = false;  ///< The file says where the volume lies, or how large its voxels are.
  std::vector<std::string> warnings = {};
  std::map<Label, std::string> label_names = {};
  std::vector<ChannelRequest> channels = {};  ///< At most one.
  std::filesystem::path path = {};            ///< Of the data.
  MappedFile data;
  std::uint64_t begin = 0;  ///< First byte of the data in the file.
  Encoding encoding = Encoding::kRaw;
  /// For kSlices: fills the span with the values of slice z. Slices are asked for in order. Throws
  /// Error.
  std::function<void(std::uint64_t z, std::span<std::byte> bytes)> read_slice = {};
  std::uint64_t skipped = 0;   ///< For kGzip: bytes to drop after decompression.
  bool may_have_more = false;  ///< Bytes after the volume are allowed.
};

/// A slice that is decoded has less bytes than this.
inline constexpr std::uint64_t kMaxSliceBytes = std::uint64_t{1} << 30;

/// Returns the source of the file's volume. Throws Error if the file is shorter than raw data must
/// be, if a slice has kMaxSliceBytes, if labels or channels are wanted of colours or of several
/// layers, and visit_all() if other data end early, are damaged, or do not end where they should.
/// Leaves out bytes after raw data, with a warning.
std::unique_ptr<VoxelSource> make_dense_source(DenseFile file);

}  // namespace voxdag
