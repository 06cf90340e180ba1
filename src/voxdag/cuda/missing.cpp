/// Replaces the CUDA backend in a build without nvcc. Every function reports that CUDA is missing.
#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_attributes.hpp"
#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/cuda/partial_picture.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/cuda/timed_casts.hpp"
#include "voxdag/cuda/trace_batch.hpp"

namespace voxdag {
namespace {

constexpr const char* kReason = "this program was built without CUDA";

[[noreturn]] void refuse() { throw Error(std::string("no CUDA device: ") + kReason); }

}  // namespace

CudaDevices cuda_devices() { return {{}, kReason}; }

DeviceScene::DeviceScene(const CudaDevice&, const VoxelSet&, DeviceLayout) { refuse(); }
DeviceScene::DeviceScene(const CudaDevice&, const SvdagView&, std::uint64_t, std::uint64_t) {
  refuse();
}
DeviceScene DeviceScene::updated(const SvdagView&, std::uint64_t, std::uint64_t,
                                 const EditChanges&) const {
  refuse();
}
const CudaDevice& DeviceScene::device() const { refuse(); }
const VoxelSet& DeviceScene::host() const { refuse(); }
const DeviceVoxels& DeviceScene::view() const { refuse(); }
void DeviceScene::make_current() const { refuse(); }

struct DeviceAttributes::Memory {};
DeviceAttributes::DeviceAttributes(const DeviceScene&, const DagAttributesView&) { refuse(); }
DeviceAttributes DeviceAttributes::updated(const DeviceScene&, const ValueOverlays&, std::uint64_t,
                                           const std::vector<EditRun>&) const {
  refuse();
}
const ColoredDagView& DeviceAttributes::view() const { refuse(); }

struct DeviceBlocks::Memory {};
DeviceBlocks::DeviceBlocks(const CudaDevice&, std::uint64_t, std::size_t) { refuse(); }
const CudaDevice& DeviceBlocks::device() const { refuse(); }
void DeviceBlocks::make_current() const { refuse(); }
void DeviceBlocks::update(const PartialEsvoView&, std::span<const SlotRange>) { refuse(); }
const PartialEsvoView& DeviceBlocks::view() const { refuse(); }
std::uint8_t* DeviceBlocks::wanted() const { refuse(); }
std::vector<std::size_t> DeviceBlocks::take_wanted() const { refuse(); }

struct PartialPicture::State {};
PartialPicture::PartialPicture(const DeviceBlocks&, const RenderPlan&, const RenderOptions&, Work) {
  refuse();
}
std::uint32_t PartialPicture::tile_count() const { refuse(); }
ViewTile PartialPicture::tile(std::uint32_t) const { refuse(); }
void PartialPicture::cast_beams() const { refuse(); }
std::vector<std::uint32_t> PartialPicture::render(std::span<const std::uint32_t>,
                                                  const char*) const {
  refuse();
}
std::uint32_t PartialPicture::most_resumed() const { refuse(); }
std::size_t PartialPicture::resume(std::span<const std::uint32_t>, int, bool) const { refuse(); }
void PartialPicture::count_steps() const { refuse(); }
void PartialPicture::copy_to(RenderedImage&) const { refuse(); }

struct CudaTracer::State {};
CudaTracer::CudaTracer(const DeviceScene&, const Grid&) { refuse(); }
void CudaTracer::trace(std::span<const Ray>, std::span<Hit>, Work) const { refuse(); }

struct TimedCasts::State {};
TimedCasts::TimedCasts(const DeviceScene&, std::span<const CastRay>) { refuse(); }
double TimedCasts::closest() const { refuse(); }
double TimedCasts::any() const { refuse(); }
void TimedCasts::copy_hits(std::span<std::uint8_t>) const { refuse(); }

struct TimedBeams::State {};
TimedBeams::TimedBeams(const DeviceScene&, const RenderSetup&) { refuse(); }
double TimedBeams::run() const { refuse(); }
std::vector<float> TimedBeams::starts() const { refuse(); }

RenderedImage render_image(const DeviceScene&, const Grid&, const RenderOptions&, Work,
                           const ViewSource*) {
  refuse();
}

}  // namespace voxdag
