/// Replaces the CUDA backend in a build without nvcc. Every function reports that CUDA is missing.
#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_scene.hpp"
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
const CudaDevice& DeviceScene::device() const { refuse(); }
const VoxelSet& DeviceScene::host() const { refuse(); }
const DeviceVoxels& DeviceScene::view() const { refuse(); }
void DeviceScene::make_current() const { refuse(); }

struct CudaTracer::State {};
CudaTracer::CudaTracer(const DeviceScene&, const Grid&) { refuse(); }
void CudaTracer::trace(std::span<const Ray>, std::span<Hit>, Progress*) const { refuse(); }

struct TimedCasts::State {};
TimedCasts::TimedCasts(const DeviceScene&, std::span<const CastRay>) { refuse(); }
double TimedCasts::closest() const { refuse(); }
double TimedCasts::any() const { refuse(); }
void TimedCasts::copy_hits(std::span<std::uint8_t>) const { refuse(); }

struct TimedBeams::State {};
TimedBeams::TimedBeams(const DeviceScene&, const RenderSetup&) { refuse(); }
double TimedBeams::run() const { refuse(); }
std::vector<float> TimedBeams::starts() const { refuse(); }

RenderedImage render_image(const DeviceScene&, const Grid&, const RenderOptions&, Progress*,
                           const ViewSource*) {
  refuse();
}

}  // namespace voxdag
