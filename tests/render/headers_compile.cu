// A picture's sample instantiated in a kernel: that it compiles as device code is the test.
#include "voxdag/render/shade.hpp"
#include "voxdag/render/tone_map.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

__global__ void shade_kernel(SvdagView dag, Grid grid, Camera camera, Sky sky, ShadeOptions options,
                             Vec3f* rgb) {
  const int x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  if (x >= camera.width || y >= camera.height) return;
  const Sample sample =
      shade_sample(SvdagNodes(dag), grid, camera, sky, options, x + 0.5, y + 0.5);
  rgb[y * camera.width + x] = tone_map(sample.radiance * options.exposure);
}

}  // namespace voxdag
