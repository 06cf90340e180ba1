#include "voxdag/formats/exports/grids/export_vox.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <string>
#include <utility>

#include "voxdag/formats/exports/count_voxels.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/grids/color_palette.hpp"
#include "voxdag/formats/exports/grids/vox_writer.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

constexpr std::int32_t kModelSide = 256, kSectionSide = 2000, kHeight = 1000;
constexpr std::uint64_t kMaxVoxVoxels = 500'000'000;  ///< Sizes in the file are signed 32-bit.
constexpr std::size_t kMaxSections = 500;             ///< All files are open at the same time.
constexpr int kMaxColors = 255;
constexpr Value8 kGrey{200, 198, 195};

/// Calls fn(box) for the boxes of at most side³ voxels that a box is cut into, x changing fastest.
template <class Fn>
void for_each_part(const Box3i& box, std::int32_t side, const Fn& fn) {
  for (std::int32_t z = box.lo.z; z < box.hi.z; z += side)
    for (std::int32_t y = box.lo.y; y < box.hi.y; y += side)
      for (std::int32_t x = box.lo.x; x < box.hi.x; x += side)
        fn(Box3i{{x, y, z}, min(box.hi, Vec3i{x, y, z} + Vec3i{side, side, side})});
}

std::filesystem::path section_path(const std::filesystem::path& path, Vec3i number) {
  std::filesystem::path section = path;
  std::string name = path.stem().string();
  for (int axis = 0; axis < 3; ++axis) name.append("-").append(std::to_string(number[axis]));
  return section.replace_filename(name.append(path.extension().string()));
}

/// Walks over the voxels of an export with their palette indices, and reports the progress. With
/// colours, each voxel is visited twice.
class Source {
 public:
  Source(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options)
      : voxels_(voxels),
        options_(options),
        look_(options.look_reader()),
        has_colors_(look_.has_colors()) {
    whole_ =
        count_voxels(voxels, window, ~std::uint64_t{0} - 1, [&] { report_export(options, 0, 1); });
    if (!has_colors_) return;
    ColorCounter counter(kMaxColors);
    visit(window, [&](Vec3i, Value8 color) { counter.add(color); });
    palette_ = counter.palette();
  }

  std::uint64_t count() const { return whole_; }
  /// Returns the number of voxels in a box.
  std::uint64_t count(const Box3i& box) const {
    return count_voxels(voxels_, box, ~std::uint64_t{0} - 1, [&] { report(); });
  }
  std::vector<Value8> colors() const {
    return has_colors_ ? palette_.colors() : std::vector<Value8>{kGrey};
  }
  /// Calls fn(voxel, palette index) for the voxels in a box; index 0 is no colour.
  template <class Fn>
  void for_each(const Box3i& box, const Fn& fn) {
    visit(box, [&](Vec3i voxel, Value8 color) {
      fn(voxel, static_cast<std::uint8_t>(has_colors_ ? palette_.index_of(color) + 1 : 1));
    });
  }

 private:
  template <class Fn>
  void visit(const Box3i& box, const Fn& fn) {
    std::uint64_t blocks = 0;
    voxels_.for_each_leaf_block(box, [&](Vec3i origin, std::uint64_t mask) {
      if (++blocks % 16384 == 0) report();
      for (; mask != 0; mask &= mask - 1, ++done_) {
        const Vec3i voxel =
            origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
        fn(voxel, has_colors_ ? look_.read(voxel, voxels_.levels()).color : Value8{});
      }
    });
    report();
  }
  void report() const { report_export(options_, done_, has_colors_ ? 2 * whole_ : whole_); }

  const VoxelSet& voxels_;
  const ExportOptions& options_;
  LookReader look_;
  bool has_colors_;
  ColorPalette palette_;
  std::uint64_t whole_ = 0, done_ = 0;
};

/// Returns the position in the scene of the first voxel of a section.
Vec3i scene_position(Vec3i size) {
  return {-(size.x / 2), -(size.y / 2), size.z <= kHeight ? 0 : -(size.z / 2)};
}

/// Writes the models of a section whose first voxel lies at `position`.
void write_models(VoxWriter& file, const Box3i& section, Vec3i position, Source& source) {
  std::vector<VoxVoxel> model;
  for_each_part(section, kModelSide, [&](const Box3i& box) {
    model.clear();
    source.for_each(box, [&](Vec3i voxel, std::uint8_t color) {
      const Vec3i at = voxel - box.lo;
      model.push_back({static_cast<std::uint8_t>(at.x), static_cast<std::uint8_t>(at.y),
                       static_cast<std::uint8_t>(at.z), color});
    });
    if (model.empty()) return;
    // Programs round the middle of an odd size differently.
    const Vec3i size = box.hi - box.lo;
    const Vec3i even{size.x + (size.x & 1), size.y + (size.y & 1), size.z + (size.z & 1)};
    file.add_model(position + (box.lo - section.lo), even, model);
  });
}

}  // namespace

std::vector<std::filesystem::path> export_vox(const std::filesystem::path& path,
                                              const VoxelSet& voxels, const Grid& grid,
                                              const ExportOptions& options) {
  refuse_pipe(path);
  const Box3i window = export_window(path, voxels, options);
  Source source(voxels, window, options);
  const Vec3i size = window.hi - window.lo;
  const bool is_cut = std::max({size.x, size.y, size.z}) > kSectionSide;
  std::vector<std::pair<std::filesystem::path, Box3i>> sections;
  for_each_part(window, kSectionSide, [&](const Box3i& box) {
    const std::uint64_t count = source.count(box);
    if (count > kMaxVoxVoxels)
      refuse_export(path, std::to_string(count) +
                              " voxels in 2000³ are more than the 500000000 that fit into a file");
    Vec3i number;
    for (int axis = 0; axis < 3; ++axis)
      number[axis] = (box.lo[axis] - window.lo[axis]) / kSectionSide;
    if (!is_cut)
      sections.emplace_back(path, box);
    else if (count > 0)
      sections.emplace_back(section_path(path, number), box);
  });
  check_disk_space(path, source.count() * sizeof(VoxVoxel));
  if (sections.empty()) sections.emplace_back(path, Box3i{window.lo, window.lo});
  if (sections.size() > kMaxSections)
    refuse_export(path, std::to_string(sections.size()) +
                            " sections of 2000³ are more than the 500 that are written at once");
  // All sections begin at one place, whatever their size.
  const Vec3i position =
      scene_position(is_cut ? Vec3i{kSectionSide, kSectionSide, kSectionSide} : size);
  std::vector<std::filesystem::path> files;
  std::vector<std::unique_ptr<VoxWriter>> writers;
  for (const auto& [file, box] : sections) {
    files.push_back(file);
    writers.push_back(std::make_unique<VoxWriter>(file));
    write_models(*writers.back(), box, position, source);
  }
  for (const std::unique_ptr<VoxWriter>& writer : writers) writer->commit(source.colors());
  std::string place;
  for (int axis = 0; axis < 3; ++axis)
    place.append(axis == 0 ? "" : ", ").append(std::to_string(position[axis]));
  ArrayLayout layout{
      "sections of 2000 voxels a side; the first voxel of each section lies at " + place,
      "palette indices", ""};
  if (is_cut) write_placement_file(path.string() + ".json", grid, window, layout, options);
  layout.content = "a scene; voxel window.lo lies at " + place;
  layout.lo_in_file = position;
  for (const auto& [file, box] : sections)
    if (file != path || !is_cut) write_placement(file, grid, box, layout, options);
  return files;
}

}  // namespace voxdag
