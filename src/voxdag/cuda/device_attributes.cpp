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

}  // namespace

struct DeviceAttributes::Memory {
  explicit Memory(const DeviceScene& of) : scene(of) {}

  DeviceScene scene;  // keeps the DAG in the device's memory
  DeviceBuffer<std::uint64_t> sums;
  DevicePages colors, normals;
  ColoredDagView view;
};

DeviceAttributes::DeviceAttributes(const DeviceScene& scene, const DagAttributesView& attributes) {
  assert(scene.host().dag() != nullptr);
  scene.make_current();
  require_device_memory(
      attributes.index.bytes() + attributes.colors.bytes() + attributes.normals.bytes(),
      kColorMemory);
  const auto memory = std::make_shared<Memory>(scene);
  ColoredDagView& view = memory->view;
  view.dag = scene.view().paper;
  view.attributes = attributes;
  memory->sums =
      upload(std::span(attributes.index.words, attributes.index.word_count()), kColorMemory);
  view.attributes.index.words = memory->sums.data();
  memory->colors = upload_pages(view.attributes.colors);
  memory->normals = upload_pages(view.attributes.normals);
  memory_ = memory;
}

const ColoredDagView& DeviceAttributes::view() const { return memory_->view; }

}  // namespace voxdag
