#pragma once
/// The channels of a DAG as fields of the rows that commands write: a number of its kind each.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "voxdag/stored/attributes/look.hpp"

namespace voxdag::cli {

class ChannelColumns {
 public:
  /// A field has the name of its channel, after "channel_" if that is one of `taken`. Refers to the
  /// bytes of the DAG, which may have no channels.
  ChannelColumns(const ColoredDagView& dag, std::span<const char* const> taken);

  /// Returns the fields for NpyHeader, ", ('heat', '<f4')" each.
  const std::string& dtype() const { return dtype_; }
  /// Returns the bytes of the fields in a row.
  std::size_t bytes() const { return bytes_; }

  /// Writes the values of a cell of `level`; if `exists` is false or the DAG has no such cell, 0
  /// for whole numbers and NaN for floats. Returns the end of the fields. Thread-safe.
  std::byte* store(std::byte* row, bool exists, Vec3i cell, int level) const;

 private:
  ColoredDagView dag_;
  std::vector<ChannelView> channels_;
  std::string dtype_;
  std::size_t bytes_ = 0;
};

}  // namespace voxdag::cli
