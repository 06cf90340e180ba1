#include "voxdag/cuda/device_attributes.hpp"

#include <cassert>

#include "voxdag/cuda/memory.hpp"

namespace voxdag {

/// Owns values in the device's memory.
struct DevicePages {
  DeviceBuffer<std::uint64_t> groups, words;
  DeviceBuffer<std::uint16_t> pages;
};

namespace {

constexpr const char* kColorMemory = "the colours and normals";

/// Copies values to the device, and makes `view` refer to the copies.
DevicePages upload_pages(ValuePagesView& view) {
  DevicePages pages;
  if (view.is_empty()) return pages;
  pages.groups = upload(std::span(view.groups, view.group_count()), kColorMemory);
  pages.words = upload(std::span(view.words, view.word_count), kColorMemory);
  pages.pages = upload(std::span(view.pages, view.page_count()), kColorMemory);
  view.groups = pages.groups.data();
  view.words = pages.words.data();
  view.pages = pages.pages.data();
  return pages;
}

/// Copies a channel to the device, and makes `view` refer to the copy.
DeviceBuffer<std::uint64_t> upload_channel(ByteChannelView& view) {
  if (view.is_empty()) return {};
  DeviceBuffer<std::uint64_t> words = upload(std::span(view.words, view.word_count), kColorMemory);
  view.words = words.data();
  return words;
}

}  // namespace

struct DeviceAttributes::Memory {
  /// The attributes that all versions of an edited DAG share.
  struct Stored {
    DeviceBuffer<std::uint64_t> sums;
    DevicePages colors, normals;
    DeviceBuffer<std::uint64_t> metallic, roughness;
  };

  explicit Memory(const DeviceScene& of) : scene(of) {}

  DeviceScene scene;  // keeps the DAG in the device's memory
  std::shared_ptr<const Stored> stored;
  std::shared_ptr<const DeviceBuffer<std::uint32_t>> overlay;
  ColoredDagView view;
};

DeviceAttributes::DeviceAttributes(const DeviceScene& scene, const DagAttributesView& attributes) {
  assert(scene.host().dag() != nullptr);
  scene.make_current();
  const MetallicRoughnessView mirrors = metallic_roughness_of(attributes.channels);
  require_device_memory(attributes.index.bytes() + attributes.colors.bytes() +
                            attributes.normals.bytes() + 8 * mirrors.metallic.word_count +
                            8 * mirrors.roughness.word_count,
                        kColorMemory);
  const auto memory = std::make_shared<Memory>(scene);
  const auto stored = std::make_shared<Memory::Stored>();
  ColoredDagView& view = memory->view;
  view.dag = scene.view().paper;
  view.attributes = attributes;
  stored->sums =
      upload(std::span(attributes.index.words, attributes.index.word_count()), kColorMemory);
  view.attributes.index.words = stored->sums.data();
  stored->colors = upload_pages(view.attributes.colors);
  stored->normals = upload_pages(view.attributes.normals);
  view.attributes.channels = {};  // They stay with the caller.
  view.metallic_roughness = mirrors;
  stored->metallic = upload_channel(view.metallic_roughness.metallic);
  stored->roughness = upload_channel(view.metallic_roughness.roughness);
  memory->stored = stored;
  memory_ = memory;
}

DeviceAttributes DeviceAttributes::updated(const DeviceScene& scene, const ValueOverlays& overlays,
                                           std::uint64_t words,
                                           const std::vector<EditRun>& changes) const {
  scene.make_current();
  const auto memory = std::make_shared<Memory>(scene);
  memory->stored = memory_->stored;
  memory->overlay = memory_->overlay;
  memory->view = memory_->view;
  // The DAG as it was read, in the arrays of this version.
  memory->view.dag.nodes = scene.view().paper.nodes;
  memory->view.dag.leaf_blocks = scene.view().paper.leaf_blocks;
  const std::uint32_t* const host = overlays.colors.words;
  if (memory->overlay == nullptr || words > memory->overlay->size()) {
    memory->overlay = std::make_shared<DeviceBuffer<std::uint32_t>>(
        make_device_buffer<std::uint32_t>(2 * words, kColorMemory));
    copy_to_device(memory->overlay->data(), host, words * sizeof(std::uint32_t));
  } else {
    for (const EditRun& run : changes)
      copy_to_device(memory->overlay->data() + run.first, host + run.first,
                     run.count * sizeof(std::uint32_t));
  }
  memory->view.overlays = overlays;
  memory->view.overlays.colors.words = memory->overlay->data();
  memory->view.overlays.normals.words = memory->overlay->data();
  memory->view.overlays.materials.words = memory->overlay->data();
  return DeviceAttributes(memory);
}

const ColoredDagView& DeviceAttributes::view() const { return memory_->view; }

}  // namespace voxdag
