#include "voxdag/cuda/device_blocks.hpp"

#include <cassert>

#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/memory.hpp"

namespace voxdag {
namespace {

constexpr const char* kBlockMemory = "the memory for blocks";

}  // namespace

struct DeviceBlocks::Memory {
  CudaDevice device;
  PartialEsvoView view;
  DeviceBuffer<std::uint64_t> slots;
  DeviceBuffer<std::uint32_t> cut;
  DeviceBuffer<std::uint8_t> wanted;
};

DeviceBlocks::DeviceBlocks(const CudaDevice& device, std::uint64_t slots, std::size_t blocks)
    : memory_(std::make_shared<Memory>()) {
  assert(slots % kEsvoPageSlots == 0);
  memory_->device = device;
  make_current();
  require_device_memory(slots * 8 + slots / 8 + blocks, kBlockMemory);
  memory_->slots = make_device_buffer<std::uint64_t>(slots, kBlockMemory);
  memory_->cut = make_device_buffer<std::uint32_t>(slots / 32, kBlockMemory);
  memory_->wanted =
      upload(std::span<const std::uint8_t>(std::vector<std::uint8_t>(blocks)), kBlockMemory);
}

const CudaDevice& DeviceBlocks::device() const { return memory_->device; }
void DeviceBlocks::make_current() const {
  check_cuda(cudaSetDevice(memory_->device.index), "starting the device");
}

void DeviceBlocks::update(const PartialEsvoView& pool, std::span<const SlotRange> changed) {
  Memory& memory = *memory_;
  assert(pool.octree.slot_count == memory.slots.size());
  for (const SlotRange& range : changed) {
    copy_to_device(memory.slots.data() + range.begin, pool.octree.slots + range.begin,
                   range.count * 8);
    copy_to_device(memory.cut.data() + range.begin / 32, pool.cut + range.begin / 32,
                   range.count / 8);
  }
  memory.view.octree = pool.octree;
  memory.view.octree.slots = memory.slots.data();
  memory.view.cut = memory.cut.data();
}

const PartialEsvoView& DeviceBlocks::view() const { return memory_->view; }
std::uint8_t* DeviceBlocks::wanted() const { return memory_->wanted.data(); }

std::vector<std::size_t> DeviceBlocks::take_wanted() const {
  std::vector<std::uint8_t> wanted(memory_->wanted.size());
  copy_to_host(wanted.data(), memory_->wanted.data(), wanted.size());
  std::vector<std::size_t> blocks;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] != 0) blocks.push_back(i);
  if (blocks.empty()) return blocks;
  wanted.assign(wanted.size(), 0);
  copy_to_device(memory_->wanted.data(), wanted.data(), wanted.size());
  return blocks;
}

}  // namespace voxdag
