#pragma once
/// Channels of files: their fields, names and kinds.
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/value_type.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {

/// Returns the kind of channel for numbers of a type: the smallest that has all of them. Whole
/// numbers of 32 and 64 bits are i32, which refuses those beyond it.
inline ChannelKind kind_of(ValueType type) {
  if (is_real(type)) return ChannelKind::kF32;
  if (type == ValueType::kUint8) return ChannelKind::kU8;
  if (type == ValueType::kUint16) return ChannelKind::kU16;
  if (type == ValueType::kInt8 || type == ValueType::kInt16) return ChannelKind::kI16;
  return ChannelKind::kI32;
}

/// Returns the channel for which a request asks; its field has numbers of the kind `of_field`.
/// Throws Error, without a file, for names and bounds that channels cannot have.
inline ChannelSpec channel_spec(const ChannelRequest& request, ChannelKind of_field) {
  ChannelSpec spec{request.name, of_field, request.bound};
  if (spec.bound > 0) spec.kind = ChannelKind::kF32;
  if (request.kind) spec.kind = *request.kind;
  if (spec.name.empty()) {
    spec.name = request.field.substr(0, 63);
    for (char& c : spec.name)
      if (!is_channel_name({&c, 1})) c = '_';
  }
  check_channel(spec);
  return spec;
}

/// Returns the places of the fields of the requests among `count` fields. `name_of(i)` is the name
/// of field i; capitals do not matter. Throws Error, without a file, for a field that is missing.
template <class NameOf>
std::vector<std::size_t> find_channel_fields(const std::vector<ChannelRequest>& requests,
                                             std::size_t count, const NameOf& name_of) {
  std::vector<std::size_t> fields;
  for (const ChannelRequest& request : requests) {
    if (request.field.empty()) throw Error("", "", "a channel needs the name of a field");
    fields.push_back(find_label_field(request.field, count, name_of));
  }
  return fields;
}

/// Checks the requests of a format that has one number for each voxel. Throws Error, without a
/// file, for more than one, and for another field than "value".
inline void check_value_requests(const std::vector<ChannelRequest>& requests) {
  if (requests.size() > 1) throw Error("", "", "has one value for each voxel, so one channel");
  if (!requests.empty() && requests[0].field != "value")
    throw Error("", "",
                "has no field " + in_quotes(requests[0].field) +
                    ": the numbers of a volume are called 'value'");
}

}  // namespace voxdag
