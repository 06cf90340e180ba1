/// Primitives of KHR_draco_mesh_compression, decoded by Draco.
#include <draco/compression/decode.h>

#include <array>
#include <cstring>

#include "voxdag/formats/readers/gltf/gltf_accessor.hpp"

namespace voxdag {
namespace {

/// The attributes that are read.
constexpr std::array kDracoAttributes = {"POSITION",   "NORMAL",     "COLOR_0",    "TEXCOORD_0",
                                         "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "JOINTS_0",
                                         "WEIGHTS_0",  "JOINTS_1",   "WEIGHTS_1"};

/// The numbers of faces and points that the bytes announce.
struct DracoCounts {
  std::uint64_t faces = 0, points = 0;
};

/// Reads the header of a mesh of bitstream 2.2, the only one that glTF allows, before Draco takes
/// memory for what it says.
DracoCounts counts_of_draco(std::string_view bytes, const GltfValue& user) {
  constexpr std::size_t kHeader = 11;
  if (bytes.size() < kHeader || !bytes.starts_with("DRACO") || bytes[5] != 2 || bytes[6] != 2 ||
      bytes[7] != draco::TRIANGULAR_MESH || (bytes[10] & 0x80) != 0)
    throw user.error("not a Draco mesh of version 2.2 without metadata");
  std::size_t at = kHeader;
  const auto next = [&]() -> std::uint64_t {
    if (at >= bytes.size()) throw user.error("the Draco data is truncated");
    return static_cast<unsigned char>(bytes[at++]);
  };
  const auto varint = [&] {
    std::uint64_t value = 0, byte = 128;
    for (int shift = 0; (byte & 128) != 0 && shift < 35; shift += 7) {
      byte = next();
      value |= (byte & 127) << shift;
    }
    return value;
  };
  const bool is_sequential = bytes[8] == draco::MESH_SEQUENTIAL_ENCODING;
  if (!is_sequential) next();  // How the surface was traversed.
  const std::uint64_t first = varint(), second = varint();
  return is_sequential ? DracoCounts{first, second} : DracoCounts{second, first};
}

/// Sets `to` to the values of all points.
template <class T>
void take_values(const draco::PointAttribute& from, std::uint32_t points, int components,
                 CountedVector<char>& to) {
  const std::size_t bytes = sizeof(T) * static_cast<std::size_t>(components);
  to.resize(points * bytes);
  for (std::uint32_t p = 0; p < points; ++p)
    from.ConvertValue<T>(from.mapped_index(draco::PointIndex(p)),
                         static_cast<std::int8_t>(components),
                         reinterpret_cast<T*>(to.data() + p * bytes));
}

}  // namespace

void GltfAccessors::decode_draco(const GltfValue& primitive) {
  const GltfValue packed = primitive["extensions"]["KHR_draco_mesh_compression"];
  const GltfValue attributes = primitive["attributes"], indices = primitive["indices"];
  const auto accessor = [&](const GltfValue& index) {
    return file_.item(GltfArray::kAccessors, index.whole(), primitive);
  };
  if (!packed.exists() || accessor(attributes["POSITION"])["bufferView"].exists()) return;
  std::optional<GltfValue> view;
  const std::string_view bytes = file_.view_bytes(packed, view);
  const DracoCounts counts = counts_of_draco(bytes, packed);
  MemoryBudget* const memory = file_.source().work().memory;
  // Draco's tables of the surface, and its values before and after their prediction.
  constexpr std::uint64_t kBytesPerFace = 128, kBytesPerPoint = 256;
  const MemoryReservation work(memory,
                               counts.faces * kBytesPerFace + counts.points * kBytesPerPoint);
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw packed.error("cannot decode: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const auto add = [&](const GltfValue& index, CountedVector<char> values) {
    accessors_.emplace(index.whole(), GltfAccessor(file_, accessor(index), std::move(values)));
  };
  for (const char* const name : kDracoAttributes) {
    const GltfValue index = attributes[name], id = packed["attributes"][name];
    if (!index.exists() || !id.exists()) continue;
    const draco::PointAttribute* const from =
        mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id.whole()));
    if (from == nullptr) throw id.error("the Draco mesh has no such attribute");
    const GltfValue value = accessor(index);
    const std::string type = value["type"].text();
    const int components = type.starts_with("VEC") ? type.back() - '0' : 0;
    if (components < 2 || components > 4) throw value.error("the elements must be vectors");
    CountedVector<char> values(memory);
    const auto take = [&]<class T>(T) {
      take_values<T>(*from, mesh.num_points(), components, values);
    };
    switch (value["componentType"].whole()) {
      case 5120:
        take(std::int8_t{});
        break;
      case 5121:
        take(std::uint8_t{});
        break;
      case 5122:
        take(std::int16_t{});
        break;
      case 5123:
        take(std::uint16_t{});
        break;
      default:
        take(float{});
    }
    add(index, std::move(values));
  }
  if (!indices.exists()) return;
  const std::uint64_t type = accessor(indices)["componentType"].whole();
  const std::size_t index_bytes = type == 5121 ? 1 : type == 5123 ? 2 : 4;
  CountedVector<char> values(3 * std::size_t{mesh.num_faces()} * index_bytes, 0,
                             CountedAllocator<char>(memory));
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t corner = mesh.face(draco::FaceIndex(f))[c].value();
      std::memcpy(values.data() + (3 * std::size_t{f} + c) * index_bytes, &corner, index_bytes);
    }
  add(indices, std::move(values));
}

}  // namespace voxdag
