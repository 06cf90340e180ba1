/// What stands for the CUDA backend in a build without nvcc.
#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_svdag.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/cuda/timed_casts.hpp"
#include "voxdag/cuda/trace_batch.hpp"

namespace voxdag {
namespace {

constexpr const char* kReason = "this program was built without CUDA";

[[noreturn]] void refuse() { throw Error(std::string("no CUDA device: ") + kReason); }

}  // namespace

CudaDevices cuda_devices() { return {{}, kReason}; }

DeviceSvdag::DeviceSvdag(const CudaDevice&, const SvdagView&, DeviceLayout) { refuse(); }
const CudaDevice& DeviceSvdag::device() const { refuse(); }
const SvdagView& DeviceSvdag::host() const { refuse(); }
const DeviceDag& DeviceSvdag::view() const { refuse(); }
void DeviceSvdag::make_current() const { refuse(); }

struct CudaTracer::State {};
CudaTracer::CudaTracer(const DeviceSvdag&, const Grid&) { refuse(); }
void CudaTracer::trace(std::span<const Ray>, std::span<Hit>, Progress*) const { refuse(); }

struct TimedCasts::State {};
TimedCasts::TimedCasts(const DeviceSvdag&, std::span<const CastRay>) { refuse(); }
double TimedCasts::closest() const { refuse(); }
double TimedCasts::any() const { refuse(); }
void TimedCasts::copy_hits(std::span<std::uint8_t>) const { refuse(); }

struct TimedBeams::State {};
TimedBeams::TimedBeams(const DeviceSvdag&, const RenderSetup&) { refuse(); }
double TimedBeams::run() const { refuse(); }

RenderedImage render_image(const DeviceSvdag&, const Grid&, const RenderOptions&, Progress*,
                           const ViewSource*) {
  refuse();
}

}  // namespace voxdag
