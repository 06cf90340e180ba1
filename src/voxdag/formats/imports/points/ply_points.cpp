#include <algorithm>
#include <cmath>
#include <string>

#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/color_range.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/readers/ply/ply_color.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/formats/readers/ply/ply_layout.hpp"
#include "voxdag/formats/readers/ply/ply_text_row.hpp"

namespace voxdag {
namespace {

/// Three coordinates, then three components of a colour if the file has them, then the opacity, the
/// scales and the rotation of a splat if the vertices are splats, then the label if one is read.
/// The channels follow.
constexpr std::size_t kMaxColumns = 15 + kMaxChannels;
using Values = std::array<double, kMaxColumns>;

/// Returns the kind of channel for numbers of a type.
ChannelKind kind_of_property(PlyType type) {
  constexpr ValueType kTypes[] = {ValueType::kInt8,   ValueType::kUint8, ValueType::kInt16,
                                  ValueType::kUint16, ValueType::kInt32, ValueType::kUint32,
                                  ValueType::kFloat,  ValueType::kDouble};
  return kind_of(kTypes[static_cast<std::size_t>(type)]);
}

class PlyPoints : public VoxelSource {
 public:
  PlyPoints(const std::filesystem::path& path, bool splats_are_points, const LabelRequest& labels,
            const std::vector<ChannelRequest>& channels)
      : file_(path, MappedFile::Access::kSequential),
        source_{file_.text(), path.string(), {}, &file_, {}},
        header_(parse_ply_header(source_, PlyUse::kPoints)) {
    read_comments();
    for (const std::string_view axis : {"x", "y", "z"}) columns_.push_back(vertex().find({axis}));
    std::vector<int> color = find_ply_color(vertex());
    const bool is_harmonic = color.empty();
    if (is_harmonic) color = find_splat_color(vertex());
    if (!color.empty()) {
      columns_.insert(columns_.end(), color.begin(), color.begin() + 3);
      first_splat_column_ = 6;
      for (std::size_t c = 0; c < 3; ++c)
        color_scales_[c] = is_harmonic ? kHarmonic : ply_color_scale(type_of(columns_[3 + c]));
      color_offset_ = is_harmonic ? kSplatMiddle : 0;
    }
    if (!splats_are_points) {
      const std::vector<int> splat = find_ply_scalars(
          vertex(),
          {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"});
      columns_.insert(columns_.end(), splat.begin(), splat.end());
    }
    has_splats_ = columns_.size() > first_splat_column_;
    const auto& properties = vertex().properties;
    const auto name_of = [&](std::size_t i) { return properties[i].name; };
    if (labels) {
      has_labels_ = true;
      columns_.push_back(static_cast<int>(find_label_field(*labels, properties.size(), name_of)));
    }
    first_channel_column_ = columns_.size();
    if (channels.size() > kMaxChannels)
      throw Error(path.string(), "", "at most 16 channels are read");
    for (const std::size_t found : find_channel_fields(channels, properties.size(), name_of)) {
      if (properties[found].count_type)
        throw Error(path.string(), "",
                    "property " + in_quotes(properties[found].name) +
                        " is a list, and a channel has one number");
      channels_.push_back(
          channel_spec(channels[channels_.size()], kind_of_property(properties[found].type)));
      columns_.push_back(static_cast<int>(found));
    }
    if (!is_harmonic) find_color_range();
  }

  bool has_points() const override { return true; }
  bool has_splats() const override { return has_splats_; }
  bool has_labels() const override { return has_labels_; }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::optional<Grid> grid() const override { return grid_; }
  std::optional<char> up() const override { return up_; }
  bool has_colors() const override { return first_splat_column_ > 3; }
  CoordinateError coordinate_error() const override {
    const bool has_floats = std::any_of(columns_.begin(), columns_.begin() + 3, [&](int property) {
      return type_of(property) == PlyType::kFloat;
    });
    return has_floats ? kFloatCoordinates : CoordinateError{};
  }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    for_each_vertex([&](const Values& values) { add(points, values); });
    points.finish();
  }

 private:
  const PlyElement& vertex() const { return header_.elements[header_.vertex]; }

  /// Reads the grid that voxdag's own exports of points name in their comments, and their turn.
  void read_comments() {
    std::string_view header = source_.bytes.substr(0, header_.body);
    if (header.find("comment made by voxdag") == header.npos) return;
    Vec3d origin, origin_before;
    double voxel_size = 0, resolution = 0;
    int found = 0, found_before = 0;
    std::string_view from_up;
    while (!header.empty()) {
      std::string_view line = next_line(header, header_.line_end);
      if (next_token(line) != "comment") continue;
      const std::string_view name = next_token(line);
      const auto number = [&](double& value) { return int{parse_float(next_token(line), value)}; };
      if (name == "grid_origin")
        for (int axis = 0; axis < 3; ++axis) found += number(origin[axis]);
      if (name == "voxel_size") found += number(voxel_size);
      if (name == "resolution") found += number(resolution);
      if (name == "from_up") from_up = next_token(line);
      if (name == "origin_before")
        for (int axis = 0; axis < 3; ++axis) found_before += number(origin_before[axis]);
    }
    int levels = kMinLevels;
    while (levels < kMaxLevels && std::ldexp(1.0, levels) < resolution) ++levels;
    const bool has_faces = std::any_of(header_.elements.begin(), header_.elements.end(),
                                       [](const PlyElement& e) { return e.name == "face"; });
    if (found != 5 || has_faces || std::ldexp(1.0, levels) != resolution || !(voxel_size > 0) ||
        !is_finite(origin) || !std::isfinite(kSubvoxels / voxel_size))
      return;
    if ((from_up == "y" || from_up == "z") && found_before == 3 && is_finite(origin_before)) {
      up_ = from_up[0];
      turn_ = turn_of_export(*up_);
      origin = origin_before;
    }
    grid_ = {levels, origin, voxel_size, kSubvoxels / voxel_size};
  }

  PlyType type_of(int property) const {
    return vertex().properties[static_cast<std::size_t>(property)].type;
  }

  /// Finds the range of colours of real numbers and of 16 bits.
  void find_color_range() {
    const auto has = [&](const auto& is_kind) {
      return std::any_of(columns_.begin() + 3, columns_.begin() + 6,
                         [&](int property) { return is_kind(type_of(property)); });
    };
    const bool are_real = has([](PlyType type) { return !is_integer(type); });
    if (!are_real && !has([](PlyType type) { return size_of(type) == 2; })) return;
    double greatest = 0;
    for_each_vertex([&](const Values& values) {
      for (std::size_t c = 3; c < 6; ++c)
        if (std::isfinite(values[c])) greatest = std::max(greatest, values[c]);
    });
    const double range = color_range(are_real, greatest, warnings_);
    if (range == 255) color_scales_.fill(1.0 / 255);
  }

  void add(BatchedVoxels& points, const Values& values) const {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const double value = values[static_cast<std::size_t>(axis)];
      point[turn_.source_axis[axis]] = turn_.is_flipped[axis] ? -value : value;
    }
    if (has_splats()) {
      const auto value = [&](std::size_t i) {
        return static_cast<float>(values[first_splat_column_ + i]);
      };
      points.add_splat(splat_of_logarithms({value(4), value(5), value(6), value(7)},
                                           {value(1), value(2), value(3)}, value(0)));
    }
    if (has_labels_) points.add_label(label_of(values[first_channel_column_ - 1]));
    for (std::size_t c = first_channel_column_; c < columns_.size(); ++c)
      points.add_channel(values[c]);
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = color_byte(values[3 + c] * color_scales_[c] + color_offset_);
    points.add(point, color);
  }

  /// Calls use(values) for all vertices.
  template <class Use>
  void for_each_vertex(const Use& use) const {
    const bool is_text = header_.format == PlyFormat::kAscii;
    try {
      if (is_text)
        visit_text(use);
      else
        visit_binary(use);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, is_text ? header_.line_end : kNoLines);
    }
  }

  template <class Use>
  void visit_binary(const Use& use) const {
    const bool swap = header_.swaps_bytes();
    const char* p = source_.bytes.data() + header_.body;
    const char* const end = source_.bytes.data() + source_.bytes.size();
    PassedPages pages(file_, p);
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      const RowLayout layout(element);
      if (&element == &vertex()) return visit_vertices(layout, p, end, swap, pages, use);
      for (std::uint64_t row = 0; row < element.count; ++row) {
        p = layout.walk(p, end, swap, [](std::size_t, const char*, std::size_t) {});
        pages.pass(p);
      }
    }
  }

  template <class Use>
  void visit_vertices(const RowLayout& layout, const char* p, const char* end, bool swap,
                      PassedPages& pages, const Use& use) const {
    for (std::uint64_t row = 0; row < vertex().count; ++row) {
      Values values{};
      p = layout.walk(p, end, swap, [&](std::size_t run, const char* fixed, std::size_t) {
        for (std::size_t c = 0; c < columns_.size(); ++c) {
          const auto property = static_cast<std::size_t>(columns_[c]);
          const Place place = layout.places[property];
          if (place.run == run)
            values[c] = load_double(vertex().properties[property].type, fixed + place.offset, swap);
        }
      });
      use(values);
      pages.pass(p);
    }
  }

  template <class Use>
  void visit_text(const Use& use) const {
    std::string_view text = source_.bytes.substr(header_.body);
    PassedPages pages(file_, text.data());
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;  // Without properties, rows have no lines.
      for (std::uint64_t row = 0; row < element.count;) {
        if (text.empty())
          throw Fault{text.data(), "the file ends after " + std::to_string(row) + " of " +
                                       std::to_string(element.count) + " rows of element " +
                                       in_quotes(element.name)};
        const std::string_view line = next_line(text, header_.line_end);
        pages.pass(text.data());
        if (trim(line).empty()) continue;
        if (&element == &vertex()) use(parse_vertex(line));
        ++row;
      }
      if (&element == &vertex()) return;
    }
  }

  Values parse_vertex(std::string_view row) const {
    CancelPoll poll({});
    Values values{};
    for (std::size_t p = 0; p < vertex().properties.size(); ++p)
      take_ply_property(row, vertex().properties[p], poll, [&](std::string_view token) {
        for (std::size_t c = 0; c < columns_.size(); ++c)
          if (columns_[c] == static_cast<int>(p) && !parse_float(token, values[c]) &&
              (c < 3 || c >= first_splat_column_))
            throw Fault{token.data(), (c < 3 ? "coordinate " : "property ") + in_quotes(token) +
                                          " is not a number"};
      });
    check_ply_row_end(row);
    return values;
  }

  MappedFile file_;
  MeshSource source_;
  PlyHeader header_;
  std::optional<Grid> grid_;  ///< Before the turn.
  std::optional<char> up_;    ///< The axis that pointed up before the turn.
  Orientation turn_;
  std::vector<int> columns_;  ///< The properties of the values.
  std::size_t first_splat_column_ = 3;
  std::size_t first_channel_column_ = 0;
  std::vector<ChannelSpec> channels_;
  bool has_splats_ = false, has_labels_ = false;
  std::array<double, 3> color_scales_{};
  double color_offset_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_ply_points(const std::filesystem::path& path,
                                             bool splats_are_points, const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  if (auto packed = open_packed_ply(path, splats_are_points)) return packed;
  return std::make_unique<PlyPoints>(path, splats_are_points, labels, channels);
}

}  // namespace voxdag
