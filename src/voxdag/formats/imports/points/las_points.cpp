#include "voxdag/formats/imports/points/las_points.hpp"

#include <cmath>

#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/las_header.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"

namespace voxdag {
namespace {

class LasPoints : public VoxelSource {
 public:
  explicit LasPoints(const std::filesystem::path& path)
      : name_(path.string()),
        file_(path, MappedFile::Access::kSequential),
        header_(parse_las_header(file_.text(), name_)),
        color_(las_color_offset(header_.format)) {
    if (color_ > 0) color_shift_ = has_wide_color() ? 8 : 0;
  }

  bool has_points() const override { return true; }
  bool has_colors() const override { return color_ > 0; }
  /// The products and sums of add() are rounded.
  CoordinateError coordinate_error() const override {
    CoordinateError error{0x1p-51, {}};
    for (int axis = 0; axis < 3; ++axis)
      error.absolute[axis] = 0x1p-52 * std::abs(header_.offset[axis]);
    return error;
  }
  std::vector<std::string> warnings() const override {
    if (!header_.has_two_counts) return {};
    return {"the header has two counts of points; the legacy one, " +
            std::to_string(header_.points) + ", is used"};
  }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    for_each_record([&](const char* record) {
      if (!is_withheld(record)) add(points, record);
      return true;
    });
    points.finish();
  }

 private:
  /// Calls on_record(record) until it returns false.
  template <class OnRecord>
  void for_each_record(const OnRecord& on_record) const {
    const char* record = file_.text().data() + header_.data;
    PassedPages pages(file_, record);
    for (std::uint64_t i = 0; i < header_.points; ++i) {
      if (!on_record(record)) return;
      record += header_.record_bytes;
      pages.pass(record);
    }
  }

  /// The flags of version 1.0 belong to the classification.
  bool is_withheld(const char* record) const {
    const auto flags = load_value<std::uint8_t>(record + 15);
    if (header_.format >= 6) return (flags & 4) != 0;
    return header_.minor_version > 0 && (flags & 128) != 0;
  }

  /// Returns whether a component of a colour needs more than 8 bits.
  bool has_wide_color() const {
    bool is_wide = false;
    for_each_record([&](const char* record) {
      for (int c = 0; c < 3; ++c)
        is_wide |= load_value<std::uint16_t>(record + color_ + 2 * c) > 255;
      return !is_wide;
    });
    return is_wide;
  }

  void add(BatchedVoxels& points, const char* record) const {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] =
          load_value<std::int32_t>(record + 4 * axis) * header_.scale[axis] + header_.offset[axis];
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<std::uint8_t>(load_value<std::uint16_t>(record + color_ + 2 * c) >>
                                           color_shift_);
    points.add(point, color);
  }

  std::string name_;
  MappedFile file_;
  LasHeader header_;
  int color_;  ///< Offset in a record; 0: none.
  int color_shift_ = 0;
};

}  // namespace

std::unique_ptr<VoxelSource> open_las_points(const std::filesystem::path& path) {
  return std::make_unique<LasPoints>(path);
}

}  // namespace voxdag
