#pragma once
/// The layout of the rows of a binary PLY file.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/ply/ply_header.hpp"

namespace voxdag {

template <class T>
T load_ply(const char* p, bool swap) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, p, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

inline std::int64_t load_int(PlyType type, const char* p, bool swap) {
  switch (type) {
    case PlyType::kInt8:
      return load_ply<std::int8_t>(p, swap);
    case PlyType::kUint8:
      return load_ply<std::uint8_t>(p, swap);
    case PlyType::kInt16:
      return load_ply<std::int16_t>(p, swap);
    case PlyType::kUint16:
      return load_ply<std::uint16_t>(p, swap);
    case PlyType::kInt32:
      return load_ply<std::int32_t>(p, swap);
    default:
      return load_ply<std::uint32_t>(p, swap);
  }
}

inline float load_float(PlyType type, const char* p, bool swap) {
  if (type == PlyType::kFloat) return load_ply<float>(p, swap);
  if (type == PlyType::kDouble) return static_cast<float>(load_ply<double>(p, swap));
  return static_cast<float>(load_int(type, p, swap));
}

inline double load_double(PlyType type, const char* p, bool swap) {
  if (type == PlyType::kFloat) return load_ply<float>(p, swap);
  if (type == PlyType::kDouble) return load_ply<double>(p, swap);
  return static_cast<double>(load_int(type, p, swap));
}

/// Properties of fixed size, followed by one list. The last run of a row has no list.
struct Run {
  std::size_t fixed_bytes = 0;
  PlyType count_type = PlyType::kUint8;
  std::size_t item_bytes = 0;  ///< 0: not a list.

  /// Returns the offset of the first item in the run.
  std::size_t list_offset() const { return fixed_bytes + size_of(count_type); }
};

/// The place of a property: its run, and its offset in bytes in the run. A list follows the run's
/// fixed bytes.
struct Place {
  std::size_t run = 0, offset = 0;
};

/// The layout of one element's rows.
struct RowLayout {
  std::vector<Run> runs{1};
  std::vector<Place> places;  ///< Per property.

  explicit RowLayout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      places.push_back({runs.size() - 1, runs.back().fixed_bytes});
      if (property.count_type) {
        runs.back().count_type = *property.count_type;
        runs.back().item_bytes = size_of(property.type);
        runs.emplace_back();
      } else {
        runs.back().fixed_bytes += size_of(property.type);
      }
    }
  }
  bool has_lists() const { return runs.size() > 1; }
  /// Returns the size of a row whose lists have `items` items each.
  std::size_t row_bytes(std::size_t items) const {
    std::size_t bytes = 0;
    for (const Run& run : runs)
      bytes += run.item_bytes > 0 ? run.list_offset() + items * run.item_bytes : run.fixed_bytes;
    return bytes;
  }

  /// Calls on_run(index, start of its fixed bytes, items in its list) for each run of the row at
  /// `p`. Returns the row's end. Throws Fault if the row extends beyond `end`.
  template <class OnRun>
  const char* walk(const char* p, const char* end, bool swap, const OnRun& on_run) const {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const Run& run = runs[k];
      const std::size_t count_bytes = run.item_bytes > 0 ? size_of(run.count_type) : 0;
      if (static_cast<std::size_t>(end - p) < run.fixed_bytes + count_bytes)
        throw Fault{p, "the file ends inside a row"};
      const char* const list = p + run.fixed_bytes;
      std::int64_t items = 0;
      if (run.item_bytes > 0) {
        items = load_int(run.count_type, list, swap);
        const auto room = static_cast<std::size_t>(end - list) - count_bytes;
        if (items < 0 || static_cast<std::uint64_t>(items) > room / run.item_bytes)
          throw Fault{list,
                      "a list of " + std::to_string(items) + " items does not fit in the file"};
      }
      on_run(k, p, static_cast<std::size_t>(items));
      p = list + count_bytes + static_cast<std::size_t>(items) * run.item_bytes;
    }
    return p;
  }
};

}  // namespace voxdag
