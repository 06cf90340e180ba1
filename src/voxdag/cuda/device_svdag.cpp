#include "voxdag/cuda/device_svdag.hpp"

#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/memory.hpp"

namespace voxdag {

struct DeviceSvdag::Memory {
  CudaDevice device;
  SvdagView host;
  DeviceDag view;
  DeviceBuffer<std::uint32_t> nodes, wide_words;
  DeviceBuffer<std::uint64_t> leaf_blocks;
};

DeviceSvdag::DeviceSvdag(const CudaDevice& device, const SvdagView& dag, DeviceLayout layout) {
  check_cuda(cudaSetDevice(device.index), "starting the device");
  WideSvdag wide;
  if (layout == DeviceLayout::kWide) wide = make_wide_svdag(dag);
  require_device_memory(dag.bytes() + wide.view().bytes(), "the DAG");
  const auto memory = std::make_shared<Memory>();
  memory->device = device;
  memory->host = memory->view.paper = dag;
  memory->view.layout = layout;
  memory->nodes = upload(std::span(dag.nodes, dag.node_words()), "the DAG");
  memory->leaf_blocks = upload(std::span(dag.leaf_blocks, dag.leaf_block_count), "the DAG");
  memory->view.paper.nodes = memory->nodes.data();
  memory->view.paper.leaf_blocks = memory->leaf_blocks.data();
  memory->wide_words = upload(std::span<const std::uint32_t>(wide.words), "the DAG");
  memory->view.wide = wide.view();
  memory->view.wide.words = memory->wide_words.data();
  memory_ = memory;
}

const CudaDevice& DeviceSvdag::device() const { return memory_->device; }
const SvdagView& DeviceSvdag::host() const { return memory_->host; }
const DeviceDag& DeviceSvdag::view() const { return memory_->view; }
void DeviceSvdag::make_current() const {
  check_cuda(cudaSetDevice(memory_->device.index), "starting the device");
}

}  // namespace voxdag
