#include "viewer/edit/edit_update.hpp"

#include <array>

namespace voxdag {
namespace {

template <class T>
void append(std::string& bytes, const T* from, std::uint64_t count) {
  bytes.append(reinterpret_cast<const char*>(from), count * sizeof(T));
}

}  // namespace

std::string EditUpdate::bytes(const EditNodes& from, const EditValues& of_values) const {
  const auto number = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const std::vector<EditRun>* const kinds[] = {&nodes.words, &nodes.blocks, &values};
  const std::array<std::uint32_t, kHeadWords> head = {writer,
                                                      root,
                                                      colors,
                                                      normals,
                                                      materials,
                                                      undos,
                                                      redos,
                                                      number(nodes.words.size()),
                                                      number(nodes.blocks.size()),
                                                      number(values.size())};
  std::string bytes;
  append(bytes, head.data(), head.size());
  for (const auto* runs : kinds)
    for (const EditRun& run : *runs) {
      const std::uint32_t ends[] = {number(run.first), number(run.count)};
      append(bytes, ends, 2);
    }
  for (const EditRun& run : nodes.words) append(bytes, from.words(number(run.first)), run.count);
  for (const EditRun& run : nodes.blocks) append(bytes, from.address(number(run.first)), run.count);
  for (const EditRun& run : values)
    append(bytes, of_values.view(kStoredValue).words + run.first, run.count);
  return bytes;
}

}  // namespace voxdag
