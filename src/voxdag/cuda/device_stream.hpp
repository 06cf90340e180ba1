#pragma once
/// Renders pictures of an ESVO on a CUDA device that has only some of its blocks in memory.
///
/// Source: C. Crassin et al., "GigaVoxels: Ray-Guided Streaming for Efficient and Detailed Voxel
/// Rendering", I3D 2009: the device notes which data its rays miss, and the host sends these data.
///
/// The host's blocks and the device's are equal copies of one pool.
#include <cstdint>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/stream/streamed_image.hpp"
#include "voxdag/cuda/device_blocks.hpp"

namespace voxdag {

/// The loaded blocks of a source, also in the memory of a CUDA device.
class DeviceStream {
 public:
  /// `source` must outlive this object; others may load blocks from it between pictures. Throws
  /// Error if the device does not have memory for the source's pool.
  DeviceStream(const CudaDevice& device, BlockSource& source);

  const CudaDevice& device() const { return blocks_.device(); }
  BlockSource& source() const { return *source_; }
  const DeviceBlocks& blocks() const { return blocks_; }

  /// Copies the blocks that have changed since the last call to the device.
  void update();
  /// Tells the source which blocks the device's rays missed since the last call, and returns them.
  std::vector<std::size_t> want_missed();

 private:
  BlockSource* source_;
  DeviceBlocks blocks_;
  std::uint64_t version_ = 0;  ///< Of the blocks on the device.
};

/// Returns the picture that render_streamed() (streamed_image.hpp) makes on the CPU, up to
/// rounding. The tiles are 16×8 pixels. If no more blocks fit, the rays of the remaining tiles wait
/// for one block after another (trace/resumed_rays.hpp), on the device too. The CPU filters. Throws
/// like the version for the CPU, and Error if the device fails or its memory is too small.
RenderedImage render_streamed(DeviceStream& stream, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass = {},
                              Work work = {});

}  // namespace voxdag
