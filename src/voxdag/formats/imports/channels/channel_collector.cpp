#include "voxdag/formats/imports/channels/channel_collector.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {

void ChannelCollector::add(Vec3i voxel, double value) {
  try {
    channel_code(spec_.kind, value);
  } catch (const Error& error) {
    throw Error("", "channel " + in_quotes(spec_.name), error.reason());
  }
  records_.add(voxel, value);
}

EncodedChannel ChannelCollector::encode(const SvdagView& dag, const CellIndexView& index) {
  CountedVector<std::int32_t> codes(work_.memory);  // of the voxels, in Morton order
  std::uint64_t code = 0, count = 0;
  double sum = 0;
  const auto finish_voxel = [&] {
    if (count > 0) codes.push_back(channel_code(spec_.kind, sum / static_cast<double>(count)));
    count = 0;
    sum = 0;
  };
  records_.visit_all([&](const VoxelRecord<double>& record) {
    if (record.code != code) finish_voxel();
    code = record.code;
    sum += record.value;
    ++count;
  });
  finish_voxel();
  std::size_t next = 0;
  return channel_of_voxels(
      dag, index, spec_, [&](Vec3i) { return value_of_code(spec_.kind, codes[next++]); }, work_);
}

}  // namespace voxdag
