#include "voxdag/formats/readers/gltf/gltf_meshopt.hpp"

#include <meshoptimizer.h>

#include "voxdag/core/printable.hpp"

namespace voxdag {

CountedVector<char> decode_meshopt(const GltfValue& packed, std::string_view bytes,
                                   MemoryBudget* memory) {
  const std::string mode = packed["mode"].text(), filter = packed["filter"].text("NONE");
  const std::uint64_t count = packed["count"].whole(), stride = packed["byteStride"].whole();
  const bool is_attributes = mode == "ATTRIBUTES";
  const bool has_stride =
      is_attributes ? stride % 4 == 0 && stride >= 4 && stride <= 256 : stride == 2 || stride == 4;
  // The decoders assume what is checked here.
  if (!has_stride || count > 0xFFFFFFFF || (mode == "TRIANGLES" && count % 3 != 0) ||
      (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) ||
      (filter == "QUATERNION" && stride != 8))
    throw packed.error("count, stride, mode and filter do not fit together");
  CountedVector<char> out(count * stride, 0, CountedAllocator<char>(memory));
  const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
  const int failed =
      is_attributes ? meshopt_decodeVertexBuffer(out.data(), count, stride, from, bytes.size())
      : mode == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(out.data(), count, stride, from, bytes.size())
      : mode == "INDICES"
          ? meshopt_decodeIndexSequence(out.data(), count, stride, from, bytes.size())
          : -1;
  if (failed != 0 && is_attributes && !bytes.empty() && from[0] > 0xA0)
    throw packed.error("version " + std::to_string(from[0] & 15) +
                       " of the compression of attributes is not supported");
  if (failed != 0) throw packed.error("the compressed bytes are malformed");
  if (!is_attributes || filter == "NONE") return out;
  if (filter == "OCTAHEDRAL")
    meshopt_decodeFilterOct(out.data(), count, stride);
  else if (filter == "QUATERNION")
    meshopt_decodeFilterQuat(out.data(), count, stride);
  else if (filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(out.data(), count, stride);
  else
    throw packed.error("the filter " + name_in_quotes(filter) + " is not supported");
  return out;
}

}  // namespace voxdag
