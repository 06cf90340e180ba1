/// The module that writes .vdb and .nvdb files: the only exporter that links OpenVDB.
#include "voxdag/formats/exports/grids/vdb_export_module.hpp"

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <bit>
#include <exception>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/formats/exports/channel_fields.hpp"
#include "voxdag/formats/exports/export_common.hpp"
#include "voxdag/formats/exports/full_nodes.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"

namespace voxdag {
namespace {

/// Sides of OpenVDB's leaves and of the nodes above them, in voxels.
constexpr std::int32_t kLeafSide = 8, kLowerSide = 128, kUpperSide = 4096;

/// Returns the bytes of the nodes that a tree gets for a cell of `side` voxels at `at`.
template <class Tree>
std::uint64_t bytes_of_new_nodes(const Tree& tree, const openvdb::Coord& at, std::int32_t side) {
  using Upper = typename Tree::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  using Leaf = typename Lower::ChildNodeType;
  constexpr std::uint64_t kRest = 128;  // what else a node or its buffer takes
  std::uint64_t bytes = 0;
  if (side < kUpperSide && tree.template probeConstNode<Upper>(at) == nullptr)
    bytes += sizeof(Upper) + kRest;
  if (side < kLowerSide && tree.template probeConstNode<Lower>(at) == nullptr)
    bytes += sizeof(Lower) + kRest;
  if (side < kLeafSide && tree.probeConstLeaf(at) == nullptr)
    bytes += sizeof(Leaf) + Leaf::SIZE * sizeof(typename Tree::ValueType) + kRest;
  return bytes;
}

/// Writes to a file at any place. Keeps the file's error, because streams do not pass exceptions
/// on.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(AtomicFile& file) : file_(file) {}
  void rethrow_error() const {
    if (error_) std::rethrow_exception(error_);
  }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    try {
      write({bytes, static_cast<std::size_t>(count)});
      return count;
    } catch (...) {
      error_ = std::current_exception();
      return 0;
    }
  }
  int_type overflow(int_type byte) override {
    const char c = traits_type::to_char_type(byte);
    return xsputn(&c, 1) == 1 ? byte : traits_type::eof();
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    if (from == std::ios_base::end) return off_type{-1};
    at_ = static_cast<std::uint64_t>(offset) + (from == std::ios_base::cur ? at_ : 0);
    return static_cast<off_type>(at_);
  }

 private:
  void write(std::string_view bytes) {
    if (at_ > file_.position()) file_.write_zeros(static_cast<std::size_t>(at_ - file_.position()));
    const std::uint64_t old = std::min<std::uint64_t>(bytes.size(), file_.position() - at_);
    if (old > 0) file_.overwrite(at_, bytes.data(), static_cast<std::size_t>(old));
    file_.write(bytes.substr(static_cast<std::size_t>(old)));
    at_ += bytes.size();
  }

  AtomicFile& file_;
  std::uint64_t at_ = 0;
  std::exception_ptr error_;
};

/// Fills OpenVDB's grids with the voxels of a window.
class GridFiller {
 public:
  GridFiller(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options)
      : voxels_(voxels),
        window_(window),
        options_(options),
        look_(options.look_reader()),
        memory_(options.memory, 0),
        density_(openvdb::FloatGrid::create(0)),
        colors_(look_.has_colors() ? openvdb::Vec3SGrid::create() : nullptr) {
    for (std::size_t i = 0; i < look_.channels().size(); ++i) {
      channels_.push_back(openvdb::FloatGrid::create(0));
      constexpr const char* kTaken[] = {"density", "Cd"};
      channels_.back()->setName(ChannelFields::field_name(look_.channels(), i, kTaken));
      channel_access_.push_back(channels_.back()->getAccessor());
    }
  }

  std::vector<openvdb::GridBase::Ptr> fill(const Grid& grid) {
    whole_ = count_for_export("", voxels_, window_, 0, options_);
    if (const SvdagView* dag = voxels_.dag();
        dag != nullptr && !colors_ && channels_.empty() && !dag->is_empty())
      add_cells(*dag, FullNodes(*dag), 0, 0, {0, 0, 0});
    else
      voxels_.for_each_leaf_block(window_,
                                  [&](Vec3i at, std::uint64_t mask) { add_block(at, mask); });
    density_->setName("density");
    density_->setGridClass(openvdb::GRID_FOG_VOLUME);
    std::vector<openvdb::GridBase::Ptr> grids{density_};
    if (colors_) {
      colors_->setName("Cd");
      grids.push_back(colors_);
    }
    grids.insert(grids.end(), channels_.begin(), channels_.end());
    for (const openvdb::GridBase::Ptr& filled : grids) filled->setTransform(transform_of(grid));
    return grids;
  }

 private:
  /// OpenVDB's index (i, j, k) is the centre of voxel (i, j, k).
  static openvdb::math::Transform::Ptr transform_of(const Grid& grid) {
    auto transform = openvdb::math::Transform::createLinearTransform(grid.voxel_size);
    const Vec3d first = grid.to_world({0.5, 0.5, 0.5});
    transform->postTranslate(openvdb::Vec3d(first.x, first.y, first.z));
    return transform;
  }

  /// Counts the nodes of a cell before they are made.
  void count_nodes(const openvdb::Coord& at, std::int32_t side) {
    std::uint64_t bytes = bytes_of_new_nodes(density_->tree(), at, side);
    if (colors_) bytes += bytes_of_new_nodes(colors_->tree(), at, side);
    for (const openvdb::FloatGrid::Ptr& channel : channels_)
      bytes += bytes_of_new_nodes(channel->tree(), at, side);
    memory_.resize(memory_.bytes() + bytes);
  }

  void add_block(Vec3i origin, std::uint64_t mask) {
    const openvdb::Coord first(origin.x, origin.y, origin.z);
    auto* leaf = density_access_.probeLeaf(first);
    if (leaf == nullptr) {
      count_nodes(first, 1);
      leaf = density_access_.touchLeaf(first);
    }
    for (; mask != 0; mask &= mask - 1, ++done_) {
      const Vec3i voxel =
          origin + morton_decode(static_cast<std::uint64_t>(std::countr_zero(mask)));
      const openvdb::Coord at(voxel.x, voxel.y, voxel.z);
      leaf->setValueOn(at, 1);
      if (!channels_.empty()) {
        look_.read_channels(voxel, voxels_.levels(), values_);
        for (std::size_t i = 0; i < channels_.size(); ++i)
          channel_access_[i].setValueOn(at, static_cast<float>(values_[i]));
      }
      if (!colors_) continue;
      const Value8 color = look_.read(voxel, voxels_.levels()).color;
      const auto linear = [](std::uint8_t code) {
        return srgb_to_linear(static_cast<float>(code) / 255);
      };
      color_access_->setValueOn(at, {linear(color.x), linear(color.y), linear(color.z)});
    }
    if (++blocks_ % 16384 == 0) report_export(options_, done_, whole_);
  }

  bool is_outside(Vec3i lo, std::int32_t side) const {
    for (int axis = 0; axis < 3; ++axis)
      if (lo[axis] >= window_.hi[axis] || lo[axis] + side <= window_.lo[axis]) return true;
    return false;
  }
  bool is_inside(Vec3i lo, std::int32_t side) const {
    for (int axis = 0; axis < 3; ++axis)
      if (lo[axis] < window_.lo[axis] || lo[axis] + side > window_.hi[axis]) return false;
    return true;
  }

  /// Adds a node: tiles if it is full, else its children.
  void add_cells(const SvdagView& dag, const FullNodes& full, int level, std::uint32_t pointer,
                 Vec3i origin) {
    const std::int32_t side = std::int32_t{1} << (dag.levels - level);
    if (is_outside(origin, side)) return;
    if (level == dag.levels - 2) {
      if (const std::uint64_t mask = dag.leaf_blocks[pointer] & leaf_window_mask(origin, window_);
          mask != 0)
        add_block(origin, mask);
      return;
    }
    if (side >= kLeafSide && is_inside(origin, side) && full.is_full(level, pointer)) {
      const openvdb::Coord first(origin.x, origin.y, origin.z);
      count_nodes(first, side);
      density_->tree().sparseFill({first, first.offsetBy(side - 1)}, 1.0f, true);
      done_ += static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) *
               static_cast<std::uint64_t>(side);
      return;
    }
    const std::uint32_t* const node = dag.nodes + pointer;
    const std::uint32_t* child = node + 1;
    for (std::uint32_t left = child_mask(node); left != 0; left &= left - 1)
      add_cells(dag, full, level + 1, *child++,
                origin + child_offset(std::countr_zero(left)) * (side / 2));
  }

  const VoxelSet& voxels_;
  Box3i window_;
  const ExportOptions& options_;
  LookReader look_;
  MemoryReservation memory_;
  openvdb::FloatGrid::Ptr density_;
  openvdb::Vec3SGrid::Ptr colors_;
  openvdb::FloatGrid::Accessor density_access_ = density_->getAccessor();
  std::optional<openvdb::Vec3SGrid::Accessor> color_access_ =
      colors_ ? std::optional(colors_->getAccessor()) : std::nullopt;
  std::vector<openvdb::FloatGrid::Ptr> channels_;
  std::vector<openvdb::FloatGrid::Accessor> channel_access_;
  std::array<double, kMaxChannels> values_{};
  std::uint64_t whole_ = 0, done_ = 0, blocks_ = 0;
};

/// Overwrites the random identifier that OpenVDB writes, so that equal voxels make equal files.
void clear_identifier(AtomicFile& file) {
  constexpr std::uint64_t kPlace = 21;  // after magic number, versions and a flag
  const std::string_view none = "00000000-0000-0000-0000-000000000000";
  file.overwrite(kPlace, none.data(), none.size());
}

void write_open_vdb(std::ostream& stream, const std::vector<openvdb::GridBase::Ptr>& grids) {
  openvdb::io::Stream(stream).write(openvdb::GridCPtrVec(grids.begin(), grids.end()));
}

void write_nano_vdb(std::ostream& stream, const std::vector<openvdb::GridBase::Ptr>& grids) {
  // NanoVDB compiles one conversion for each type named here, and a dozen for GridBase.
  std::vector<nanovdb::GridHandle<nanovdb::HostBuffer>> handles;
  for (const openvdb::GridBase::Ptr& grid : grids)
    if (const auto density = openvdb::GridBase::grid<openvdb::FloatGrid>(grid))
      handles.push_back(nanovdb::openToNanoVDB(*density));
    else
      handles.push_back(nanovdb::openToNanoVDB(*openvdb::GridBase::grid<openvdb::Vec3SGrid>(grid)));
  nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(stream, handles,
                                                            nanovdb::io::Codec::NONE);
}

/// Throws the file's error if it cannot be written, else what the libraries throw.
void write_grids(AtomicFile& file, bool is_nano, const std::vector<openvdb::GridBase::Ptr>& grids,
                 MemoryBudget* memory) {
  std::uint64_t copy = 0;  // NanoVDB's grids, about as large
  for (const openvdb::GridBase::Ptr& grid : grids) copy += is_nano ? grid->memUsage() : 0;
  const MemoryReservation nano(memory, copy);
  FileBuffer buffer(file);
  std::ostream stream(&buffer);
  try {
    is_nano ? write_nano_vdb(stream, grids) : write_open_vdb(stream, grids);
    stream.flush();
  } catch (const std::exception&) {
    buffer.rethrow_error();
    throw;
  }
  buffer.rethrow_error();
}

void write_in_module(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                     const Box3i& window, const ExportOptions& options) {
  const bool is_nano = lower_case(path.extension().string()) == ".nvdb";
  // The libraries that this module loads take about 34 MB.
  const MemoryReservation libraries(options.memory, std::uint64_t{36} << 20);
  try {
    AtomicFile file(path);
    openvdb::initialize();
    GridFiller filler(voxels, window, options);  // counts the grids as long as it lives
    write_grids(file, is_nano, filler.fill(grid), options.memory);
    if (!is_nano) clear_identifier(file);
    file.commit();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const openvdb::Exception& error) {
    throw Error(path.string(), "", "OpenVDB: " + printable(error.what()));
  } catch (const std::runtime_error& error) {
    throw Error(path.string(), "", "OpenVDB: " + printable(error.what()));
  }
}

}  // namespace
}  // namespace voxdag

extern "C" const voxdag::VdbExportModule voxdag_vdb_export_module = {voxdag::write_in_module};
