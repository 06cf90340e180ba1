/// Reads the compressed PLY files of PlayCanvas: Gaussian splats of 16 bytes.
///
/// Source: PlayCanvas, splat-transform, "compressed PLY".
#include <cmath>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/passed_pages.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/points/splat_source.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/formats/readers/ply/ply_layout.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kChunkSplats = 256;  ///< That share a chunk.

/// The rows of an element that has no lists, in a binary file.
struct PackedRows {
  const char* first = nullptr;
  std::size_t stride = 0;
  std::vector<std::size_t> offsets;  ///< Of the properties that are read.

  template <class T>
  T load(std::uint64_t row, std::size_t property) const {
    return load_value<T>(first + row * stride + offsets[property]);
  }
};

/// Returns some bits of a word as a number from 0 to 1.
double fraction_of(std::uint32_t word, int shift, int bits) {
  const std::uint32_t most = (1u << bits) - 1;
  return static_cast<double>(word >> shift & most) / most;
}

/// Returns the three fractions of 11, 10 and 11 bits.
Vec3d three_fractions(std::uint32_t word) {
  return {fraction_of(word, 21, 11), fraction_of(word, 11, 10), fraction_of(word, 0, 11)};
}

/// Returns the quaternion w, x, y, z of which the greatest part is left out.
std::array<float, 4> unpack_rotation(std::uint32_t word) {
  const auto part = [&](int shift) {
    return (fraction_of(word, shift, 10) - 0.5) * std::sqrt(2.0);
  };
  return rotation_of_three({part(20), part(10), part(0)}, word >> 30);
}

class PackedPly final : public SplatSource {
 public:
  PackedPly(const std::filesystem::path& path, bool splats_are_points)
      : SplatSource(splats_are_points),
        file_(path, MappedFile::Access::kSequential),
        source_{file_.text(), path.string(), {}, &file_, {}},
        header_(parse_ply_header(source_, PlyUse::kPoints)) {
    if (vertex().find({"packed_position"}) < 0) return;
    if (header_.format != PlyFormat::kLittleEndian)
      fail("compressed splats must have the format binary_little_endian");
    const char* rows = source_.bytes.data() + header_.body;
    for (const PlyElement& element : header_.elements) {
      const RowLayout layout(element);
      if (layout.has_lists()) fail("element " + in_quotes(element.name) + " has lists");
      const std::uint64_t bytes = element.count * layout.row_bytes(0);
      if (bytes > static_cast<std::uint64_t>(source_.bytes.data() + source_.bytes.size() - rows))
        fail("the file ends inside element " + in_quotes(element.name));
      if (element.name == "chunk") {
        chunks_ =
            rows_of(element, rows, PlyType::kFloat,
                    {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x",
                     "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"});
        if (element.find({"min_r"}) >= 0)
          colors_ = rows_of(element, rows, PlyType::kFloat,
                            {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"});
        if (element.count < (vertex().count + kChunkSplats - 1) / kChunkSplats)
          fail("has " + std::to_string(element.count) + " chunks of 256 splats for " +
               std::to_string(vertex().count) + " splats");
      }
      if (element.name == "vertex")
        splats_ = rows_of(element, rows, PlyType::kUint32,
                          {"packed_position", "packed_rotation", "packed_scale", "packed_color"});
      rows += bytes;
    }
    if (chunks_.first == nullptr) fail("compressed splats need element 'chunk'");
  }

  bool is_packed() const { return splats_.first != nullptr; }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels splats(visit);
    PassedPages pages(file_, splats_.first);
    for (std::uint64_t i = 0; i < vertex().count; ++i) {
      add(splats, i);
      pages.pass(splats_.first + i * splats_.stride);
    }
    splats.finish();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw Error(source_.name, "", reason); }

  const PlyElement& vertex() const { return header_.elements[header_.vertex]; }

  PackedRows rows_of(const PlyElement& element, const char* first, PlyType type,
                     std::initializer_list<std::string_view> names) const {
    const RowLayout layout(element);
    PackedRows rows{first, layout.row_bytes(0), {}};
    for (const std::string_view name : names) {
      const int property = element.find({name});
      if (property < 0 || element.properties[property].type != type)
        fail("element " + in_quotes(element.name) + " of compressed splats needs property " +
             in_quotes(name) + (type == PlyType::kFloat ? " of type float" : " of type uint"));
      rows.offsets.push_back(layout.places[static_cast<std::size_t>(property)].offset);
    }
    return rows;
  }

  /// Returns a vector between those of properties `least` and least + 3 of a chunk.
  Vec3d between(const PackedRows& rows, std::uint64_t splat, std::size_t least, Vec3d at) const {
    Vec3d value;
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      const double lo = rows.load<float>(splat / kChunkSplats, least + k),
                   hi = rows.load<float>(splat / kChunkSplats, least + 3 + k);
      value[axis] = lo * (1 - at[axis]) + hi * at[axis];
    }
    return value;
  }

  void add(BatchedVoxels& splats, std::uint64_t i) const {
    const auto word = [&](std::size_t property) {
      return splats_.load<std::uint32_t>(i, property);
    };
    const std::uint32_t packed_color = word(3);
    if (has_splats()) {
      const Vec3d log_scale = between(chunks_, i, 6, three_fractions(word(2)));
      Splat splat =
          splat_of_logarithms(unpack_rotation(word(1)),
                              {static_cast<float>(log_scale.x), static_cast<float>(log_scale.y),
                               static_cast<float>(log_scale.z)},
                              0);
      splat.extinction = extinction_of(fraction_of(packed_color, 0, 8));
      splats.add_splat(splat);
    }
    Vec3d color{fraction_of(packed_color, 24, 8), fraction_of(packed_color, 16, 8),
                fraction_of(packed_color, 8, 8)};
    if (colors_.first != nullptr) color = between(colors_, i, 0, color);
    splats.add(between(chunks_, i, 0, three_fractions(word(0))),
               {color_byte(color.x), color_byte(color.y), color_byte(color.z)});
  }

  MappedFile file_;
  MeshSource source_;
  PlyHeader header_;
  PackedRows chunks_, colors_, splats_;  ///< Colours only if chunks have some.
};

}  // namespace

std::unique_ptr<VoxelSource> open_packed_ply(const std::filesystem::path& path,
                                             bool splats_are_points) {
  auto source = std::make_unique<PackedPly>(path, splats_are_points);
  if (!source->is_packed()) return nullptr;
  return source;
}

}  // namespace voxdag
