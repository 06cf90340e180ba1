#include "voxdag/cuda/device_scene.hpp"

#include <cassert>

#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/memory.hpp"

namespace voxdag {

struct DeviceScene::Memory {
  explicit Memory(const VoxelSet& scene) : host(scene) {}

  CudaDevice device;
  VoxelSet host;
  DeviceVoxels view;
  DeviceBuffer<std::uint32_t> nodes, wide_words;
  DeviceBuffer<std::uint64_t> leaf_blocks, slots;
};

DeviceScene::DeviceScene(const CudaDevice& device, const VoxelSet& scene, DeviceLayout layout) {
  check_cuda(cudaSetDevice(device.index), "starting the device");
  const auto memory = std::make_shared<Memory>(scene);
  memory->device = device;
  DeviceVoxels& view = memory->view;
  view.layout = layout;
  if (const EsvoView* esvo = scene.esvo()) {
    assert(layout == DeviceLayout::kContours || layout == DeviceLayout::kCubes);
    require_device_memory(array_bytes<std::uint64_t>(esvo->slot_count), "the octree");
    memory->slots = upload(std::span(esvo->slots, esvo->slot_count), "the octree");
    view.esvo = *esvo;
    view.esvo.slots = memory->slots.data();
    memory_ = memory;
    return;
  }
  assert(layout == DeviceLayout::kPaper || layout == DeviceLayout::kWide);
  const SvdagView& dag = *scene.dag();
  WideSvdag wide;
  if (layout == DeviceLayout::kWide) wide = make_wide_svdag(dag);
  require_device_memory(dag.bytes() + wide.view().bytes(), "the DAG");
  memory->nodes = upload(std::span(dag.nodes, dag.node_words()), "the DAG");
  memory->leaf_blocks = upload(std::span(dag.leaf_blocks, dag.leaf_block_count), "the DAG");
  view.paper = dag;
  view.paper.nodes = memory->nodes.data();
  view.paper.leaf_blocks = memory->leaf_blocks.data();
  memory->wide_words = upload(std::span<const std::uint32_t>(wide.words), "the DAG");
  view.wide = wide.view();
  view.wide.words = memory->wide_words.data();
  memory_ = memory;
}

const CudaDevice& DeviceScene::device() const { return memory_->device; }
const VoxelSet& DeviceScene::host() const { return memory_->host; }
const DeviceVoxels& DeviceScene::view() const { return memory_->view; }
void DeviceScene::make_current() const {
  check_cuda(cudaSetDevice(memory_->device.index), "starting the device");
}

}  // namespace voxdag
