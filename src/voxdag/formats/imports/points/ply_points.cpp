#include <algorithm>
#include <string>

#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/readers/ply/ply_color.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/formats/readers/ply/ply_layout.hpp"
#include "voxdag/formats/readers/ply/ply_text_row.hpp"

namespace voxdag {
namespace {

/// Three coordinates, then three components of a colour if the file has them.
using Values = std::array<double, 6>;

std::uint8_t to_8_bits(double component) {
  return static_cast<std::uint8_t>(component > 0 ? std::min(component, 1.0) * 255 + 0.5 : 0);
}

class PlyPoints : public VoxelSource {
 public:
  explicit PlyPoints(const std::filesystem::path& path)
      : file_(path, MappedFile::Access::kSequential),
        source_{file_.text(), path.string(), {}, &file_, {}},
        header_(parse_ply_header(source_, PlyUse::kPoints)) {
    for (const std::string_view axis : {"x", "y", "z"}) columns_.push_back(vertex().find({axis}));
    std::vector<int> color = find_ply_color(vertex());
    if (color.empty()) return;
    color.resize(3);
    for (std::size_t c = 0; c < 3; ++c) {
      columns_.push_back(color[c]);
      color_scales_[c] = ply_color_scale(vertex().properties[color[c]].type);
    }
  }

  bool has_points() const override { return true; }
  bool has_colors() const override { return columns_.size() > 3; }
  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels points(visit);
    const bool is_text = header_.format == PlyFormat::kAscii;
    try {
      if (is_text)
        visit_text(points);
      else
        visit_binary(points);
    } catch (const Fault& fault) {
      throw_fault(source_, fault, is_text ? header_.line_end : kNoLines);
    }
    points.finish();
  }

 private:
  const PlyElement& vertex() const { return header_.elements[header_.vertex]; }

  void add(BatchedVoxels& points, const Values& values, const char* row) const {
    const Vec3d point{values[0], values[1], values[2]};
    if (!is_finite(point)) throw Fault{row, "the point is not finite"};
    if (!has_colors()) return points.add(point);
    Rgb8 color;
    for (std::size_t c = 0; c < 3; ++c) color[c] = to_8_bits(values[3 + c] * color_scales_[c]);
    points.add(point, color);
  }

  void visit_binary(BatchedVoxels& points) const {
    const bool swap = header_.swaps_bytes();
    const char* p = source_.bytes.data() + header_.body;
    const char* const end = source_.bytes.data() + source_.bytes.size();
    PassedPages pages(file_, p);
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      const RowLayout layout(element);
      if (&element == &vertex()) return visit_vertices(layout, p, end, swap, pages, points);
      for (std::uint64_t row = 0; row < element.count; ++row) {
        p = layout.walk(p, end, swap, [](std::size_t, const char*, std::size_t) {});
        pages.pass(p);
      }
    }
  }

  void visit_vertices(const RowLayout& layout, const char* p, const char* end, bool swap,
                      PassedPages& pages, BatchedVoxels& points) const {
    for (std::uint64_t row = 0; row < vertex().count; ++row) {
      Values values{};
      const char* const start = p;
      p = layout.walk(p, end, swap, [&](std::size_t run, const char* fixed, std::size_t) {
        for (std::size_t c = 0; c < columns_.size(); ++c) {
          const auto property = static_cast<std::size_t>(columns_[c]);
          const Place place = layout.places[property];
          if (place.run == run)
            values[c] = load_double(vertex().properties[property].type, fixed + place.offset, swap);
        }
      });
      add(points, values, start);
      pages.pass(p);
    }
  }

  void visit_text(BatchedVoxels& points) const {
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
        if (&element == &vertex()) parse_vertex(line, points);
        ++row;
      }
      if (&element == &vertex()) return;
    }
  }

  void parse_vertex(std::string_view row, BatchedVoxels& points) const {
    const char* const start = row.data();
    CancelPoll poll({});
    Values values{};
    for (std::size_t p = 0; p < vertex().properties.size(); ++p)
      take_ply_property(row, vertex().properties[p], poll, [&](std::string_view token) {
        for (std::size_t c = 0; c < columns_.size(); ++c)
          if (columns_[c] == static_cast<int>(p) && !parse_float(token, values[c]) && c < 3)
            throw Fault{token.data(), "coordinate " + in_quotes(token) + " is not a number"};
      });
    check_ply_row_end(row);
    add(points, values, start);
  }

  MappedFile file_;
  MeshSource source_;
  PlyHeader header_;
  std::vector<int> columns_;  ///< The properties of the values.
  std::array<double, 3> color_scales_{};
};

}  // namespace

std::unique_ptr<VoxelSource> open_ply_points(const std::filesystem::path& path) {
  return std::make_unique<PlyPoints>(path);
}

}  // namespace voxdag
