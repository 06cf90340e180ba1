#pragma once
/// Reads an array of questions and writes an array of answers, a batch of rows at a time.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "cli/session.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag::cli {

/// A batch of rows in memory at a time.
constexpr std::size_t kPointsPerBatch = std::size_t{1} << 18;

/// Appends the bytes of a value to a row.
template <class T>
std::byte* store_value(std::byte* at, const T& value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

/// Reads rows of `columns` floats or doubles, and writes rows of `row_bytes` bytes, a batch at a
/// time: answer(numbers of all rows, number of rows, output).
template <class Answer>
std::uint64_t answer_rows(const std::string& input, std::uint64_t columns,
                          const std::string& output, const std::string& dtype,
                          std::size_t row_bytes, Session& session, const Answer& answer) {
  NpyReader reader(input, {columns});
  NpyWriter writer(output, dtype, {}, row_bytes, reader.rows());
  const auto most =
      static_cast<std::size_t>(std::min<std::uint64_t>(kPointsPerBatch, reader.rows()));
  std::vector<double> values(most * columns);
  std::vector<float> floats(reader.has_doubles() ? 0 : values.size());
  std::vector<std::byte> rows(most * row_bytes);
  void* const out = reader.has_doubles() ? static_cast<void*>(values.data()) : floats.data();
  while (const std::size_t count = reader.read_rows(out, most)) {
    std::copy(floats.begin(), floats.end(), values.begin());
    session.progress.throw_if_cancelled();
    answer(values, count, rows);
    writer.write_rows(rows.data(), count);
    session.progress.report(
        "query", static_cast<double>(writer.rows_written()) / static_cast<double>(reader.rows()),
        writer.rows_written());
  }
  writer.commit();
  return reader.rows();
}

}  // namespace voxdag::cli
