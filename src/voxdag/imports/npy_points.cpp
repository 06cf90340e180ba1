#include <array>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/imports/voxel_source.hpp"

namespace voxdag {
namespace {

/// Rows in memory at a time.
constexpr std::size_t kBatch = std::size_t{1} << 16;

template <class T>
class NpyPoints : public VoxelSource {
 public:
  NpyPoints(std::filesystem::path path, const char* dtype) : path_(std::move(path)), dtype_(dtype) {
    open();
  }

  bool has_points() const override { return std::is_floating_point_v<T>; }
  void visit_all(const std::function<void(Vec3d)>& visit) const override {
    NpyReader reader = open();
    std::vector<std::array<T, 3>> rows(kBatch);
    while (const std::size_t count = reader.read_rows(rows.data(), kBatch))
      for (std::size_t i = 0; i < count; ++i)
        visit({static_cast<double>(rows[i][0]), static_cast<double>(rows[i][1]),
               static_cast<double>(rows[i][2])});
  }

 private:
  NpyReader open() const { return NpyReader(path_, dtype_, {3}, sizeof(T)); }

  std::filesystem::path path_;
  std::string dtype_;
};

/// Returns the source if the array has this type; otherwise sets `reason`.
template <class T>
std::unique_ptr<VoxelSource> try_open(const std::filesystem::path& path, const char* dtype,
                                      std::string& reason) {
  try {
    return std::make_unique<NpyPoints<T>>(path, dtype);
  } catch (const Error& error) {
    reason = error.reason();
    return nullptr;
  }
}

}  // namespace

std::unique_ptr<VoxelSource> open_npy_points(const std::filesystem::path& path) {
  std::string reason;
  if (auto source = try_open<std::int32_t>(path, "<i4", reason)) return source;
  if (auto source = try_open<float>(path, "<f4", reason)) return source;
  try {
    return std::make_unique<NpyPoints<double>>(path, "<f8");
  } catch (const Error& error) {
    throw Error(path.string(), "",
                "is no array of shape (N, 3) of '<i4', '<f4' or '<f8': " + error.reason());
  }
}

}  // namespace voxdag
