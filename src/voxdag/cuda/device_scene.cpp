#include "voxdag/cuda/device_scene.hpp"

#include <cassert>

#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/memory.hpp"

namespace voxdag {

/// The words of a DAG, which versions of it share.
struct DagBuffers {
  DeviceBuffer<std::uint32_t> nodes;
  DeviceBuffer<std::uint64_t> leaf_blocks;
};

namespace {

/// Copies a DAG to the device, with room for `room` parts of it.
std::shared_ptr<const DagBuffers> upload_dag(const SvdagView& dag, std::uint64_t words,
                                             std::uint64_t blocks, double room) {
  const auto with_room = [&](std::uint64_t count) {
    return count + static_cast<std::uint64_t>(static_cast<double>(count) * room);
  };
  auto buffers = std::make_shared<DagBuffers>();
  buffers->nodes = make_device_buffer<std::uint32_t>(with_room(words), "the DAG");
  buffers->leaf_blocks = make_device_buffer<std::uint64_t>(with_room(blocks), "the DAG");
  copy_to_device(buffers->nodes.data(), dag.nodes, words * sizeof(std::uint32_t));
  copy_to_device(buffers->leaf_blocks.data(), dag.leaf_blocks, blocks * sizeof(std::uint64_t));
  return buffers;
}

/// Copies the runs of an array to the device.
template <class T>
void copy_runs(T* device, const T* host, const std::vector<EditRun>& runs) {
  for (const EditRun& run : runs)
    copy_to_device(device + run.first, host + run.first, run.count * sizeof(T));
}

}  // namespace

struct DeviceScene::Memory {
  explicit Memory(const VoxelSet& scene) : host(scene) {}

  /// Makes the view of a DAG in the paper's layout.
  void show(const SvdagView& of) {
    view.paper = of;
    view.paper.nodes = dag->nodes.data();
    view.paper.leaf_blocks = dag->leaf_blocks.data();
  }

  CudaDevice device;
  VoxelSet host;
  DeviceVoxels view;
  std::shared_ptr<const DagBuffers> dag;
  DeviceBuffer<std::uint64_t> slots, top_cells;
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
  assert(layout == DeviceLayout::kPaper || layout == DeviceLayout::kTop);
  const SvdagView& dag = *scene.dag();
  const TopGrid top = make_top_grid(dag, layout == DeviceLayout::kTop ? top_level(dag.levels) : 0);
  require_device_memory(dag.bytes() + array_bytes<std::uint64_t>(top.cells.size()), "the DAG");
  memory->dag = upload_dag(dag, dag.node_words(), dag.leaf_block_count, 0);
  memory->show(dag);
  memory->top_cells = upload(std::span<const std::uint64_t>(top.cells), "the DAG");
  view.top = {memory->top_cells.data(), top.level};
  memory_ = memory;
}

DeviceScene::DeviceScene(const CudaDevice& device, const SvdagView& dag, std::uint64_t words,
                         std::uint64_t blocks) {
  check_cuda(cudaSetDevice(device.index), "starting the device");
  const auto memory = std::make_shared<Memory>(dag);
  memory->device = device;
  memory->dag = upload_dag(dag, words, blocks, 0.125);
  memory->show(dag);
  memory_ = memory;
}

DeviceScene DeviceScene::updated(const SvdagView& dag, std::uint64_t words, std::uint64_t blocks,
                                 const EditChanges& changes) const {
  make_current();
  const auto memory = std::make_shared<Memory>(dag);
  memory->device = memory_->device;
  memory->dag = memory_->dag;
  if (words > memory->dag->nodes.size() || blocks > memory->dag->leaf_blocks.size()) {
    memory->dag = upload_dag(dag, words, blocks, 0.125);
  } else {
    copy_runs(memory->dag->nodes.data(), dag.nodes, changes.words);
    copy_runs(memory->dag->leaf_blocks.data(), dag.leaf_blocks, changes.blocks);
  }
  memory->show(dag);
  return DeviceScene(memory);
}

const CudaDevice& DeviceScene::device() const { return memory_->device; }
const VoxelSet& DeviceScene::host() const { return memory_->host; }
const DeviceVoxels& DeviceScene::view() const { return memory_->view; }
void DeviceScene::make_current() const {
  check_cuda(cudaSetDevice(memory_->device.index), "starting the device");
}

}  // namespace voxdag
