#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"

namespace voxdag {
namespace {

/// Rows in memory at a time.
constexpr std::size_t kBatch = 4096;

template <class T>
class NpyPoints : public VoxelSource {
 public:
  NpyPoints(std::filesystem::path path, const char* dtype) : path_(std::move(path)), dtype_(dtype) {
    open();
  }

  bool has_points() const override { return std::is_floating_point_v<T>; }
  void visit_all(const VisitBatch& visit) const override {
    NpyReader reader = open();
    std::vector<Vec3<T>> rows(kBatch);
    std::vector<Vec3d> places;
    while (const std::size_t count = reader.read_rows(rows.data(), kBatch)) {
      places.clear();
      for (std::size_t i = 0; i < count; ++i) places.push_back(static_cast<Vec3d>(rows[i]));
      visit({places, {}});
    }
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
