#include "voxdag/cuda/device_svdag.hpp"

#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/memory.hpp"

namespace voxdag {

struct DeviceSvdag::Memory {
  CudaDevice device;
  SvdagView host, view;
  DeviceBuffer<std::uint32_t> nodes;
  DeviceBuffer<std::uint64_t> leaf_blocks;
};

DeviceSvdag::DeviceSvdag(const CudaDevice& device, const SvdagView& dag) {
  check_cuda(cudaSetDevice(device.index), "starting the device");
  require_device_memory(dag.bytes(), "the DAG");
  const auto memory = std::make_shared<Memory>();
  memory->device = device;
  memory->host = memory->view = dag;
  memory->nodes = upload(std::span(dag.nodes, dag.node_words()), "the DAG");
  memory->leaf_blocks = upload(std::span(dag.leaf_blocks, dag.leaf_block_count), "the DAG");
  memory->view.nodes = memory->nodes.data();
  memory->view.leaf_blocks = memory->leaf_blocks.data();
  memory_ = memory;
}

const CudaDevice& DeviceSvdag::device() const { return memory_->device; }
const SvdagView& DeviceSvdag::host() const { return memory_->host; }
const SvdagView& DeviceSvdag::view() const { return memory_->view; }
void DeviceSvdag::make_current() const {
  check_cuda(cudaSetDevice(memory_->device.index), "starting the device");
}

}  // namespace voxdag
