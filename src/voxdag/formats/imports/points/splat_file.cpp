/// Reads .splat files: the form that antimatter15's viewer gave Gaussian splats.
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/points/splat_source.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kSplatBytes = 32;

class SplatFile final : public SplatSource {
 public:
  SplatFile(const std::filesystem::path& path, bool splats_are_points)
      : SplatSource(splats_are_points), file_(path, MappedFile::Access::kSequential) {
    if (file_.text().size() % kSplatBytes != 0)
      throw Error(path.string(), ErrorPlace::byte(file_.text().size()),
                  "the file ends inside a record of 32 bytes");
  }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels splats(visit);
    const std::string_view bytes = file_.text();
    PassedPages pages(file_, bytes.data());
    for (std::size_t at = 0; at < bytes.size(); at += kSplatBytes) {
      const char* const record = bytes.data() + at;
      const auto number = [&](int i) { return load_value<float>(record + 4 * i); };
      const auto byte = [&](int i) { return load_value<std::uint8_t>(record + 24 + i); };
      if (has_splats()) {
        Splat splat{{}, {number(3), number(4), number(5)}, extinction_of(byte(3) / 255.0)};
        for (int i = 0; i < 4; ++i)
          splat.rotation[static_cast<std::size_t>(i)] = static_cast<float>(byte(4 + i) - 128);
        splats.add_splat(splat);
      }
      splats.add({number(0), number(1), number(2)}, {byte(0), byte(1), byte(2)});
      pages.pass(record);
    }
    splats.finish();
  }

 private:
  MappedFile file_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_splat_file(const std::filesystem::path& path,
                                             bool splats_are_points) {
  return std::make_unique<SplatFile>(path, splats_are_points);
}

}  // namespace voxdag
