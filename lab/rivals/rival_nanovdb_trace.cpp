/// NanoVDB's hierarchical DDA on a CUDA device, for comparison with `voxdag bench trace --device
/// cuda`: makes a mask grid with the voxels of a .vdag file, and finds whether each ray meets an
/// active voxel. trace_program.hpp says how to call it; THREADS has no effect.
#include <nanovdb/util/OpenToNanoVDB.h>

#include <memory>
#include <vector>

#include "lab/rays/warm_seconds.hpp"
#include "lab/rivals/nanovdb_kernel.hpp"
#include "lab/rivals/openvdb_mask.hpp"
#include "lab/rivals/trace_program.hpp"
#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/memory.hpp"
#include "voxdag/cuda/stream.hpp"

namespace {

using voxdag::NanoVdbRay;
using DeviceBytes = voxdag::DeviceBuffer<std::uint8_t>;

/// Returns the grid in the memory of the device.
DeviceBytes make_device_mask(const voxdag::SvdagView& dag) {
  const auto mask = nanovdb::openToNanoVDB(*voxdag::lab::openvdb_mask_of(dag));
  return voxdag::upload<std::uint8_t>({mask.data(), mask.size()}, "the NanoVDB grid");
}

NanoVdbRay to_index_space(const voxdag::Grid& grid, const voxdag::Ray& ray) {
  const auto [eye, way] = voxdag::lab::to_voxels(grid, ray);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {{narrow(eye.x), narrow(eye.y), narrow(eye.z)},
          {narrow(way.x), narrow(way.y), narrow(way.z)},
          ray.t_min,
          ray.t_max};
}

double cast_all(const DeviceBytes& mask, const voxdag::Grid& grid,
                std::span<const voxdag::Ray> rays, std::span<char> hits) {
  if (rays.empty()) return 0;
  std::vector<NanoVdbRay> index_rays;
  index_rays.reserve(rays.size());
  for (const voxdag::Ray& ray : rays) index_rays.push_back(to_index_space(grid, ray));
  const auto device_rays = voxdag::upload<NanoVdbRay>(index_rays, "rays");
  const auto device_hits = voxdag::make_device_buffer<std::uint8_t>(rays.size(), "hits");
  const double seconds = voxdag::lab::warm_seconds([&] {
    return voxdag::seconds_of("casting rays", [&](cudaStream_t stream) {
      voxdag::lab::launch_nanovdb_hits(mask.data(), device_rays.data(), device_hits.data(),
                                       static_cast<std::uint32_t>(rays.size()), stream);
    });
  });
  voxdag::copy_to_host(hits.data(), device_hits.data(), hits.size());
  return seconds;
}

voxdag::lab::TraceProgram make_program(const voxdag::VdagFile& file, int /*threads*/) {
  voxdag::choose_cuda_device();  // fails with its reason if there is none
  openvdb::initialize();
  const auto mask = std::make_shared<DeviceBytes>(make_device_mask(file.view()));
  return {[mask, grid = file.grid()](std::span<const voxdag::Ray> rays, std::span<char> hits) {
            return cast_all(*mask, grid, rays, hits);
          },
          mask->size()};
}

}  // namespace

int main(int argc, char** argv) {
  return voxdag::lab::run_trace_program(argc, argv, "rival_nanovdb_trace", make_program);
}
