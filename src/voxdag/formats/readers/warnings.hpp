#pragma once
/// Warnings of a reader, limited in number.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace voxdag {

/// Returns a number and its noun: "1 triangle", "3 triangles".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Keeps the first kMax warnings and counts the rest.
class Warnings {
 public:
  static constexpr std::size_t kMax = 200;

  void add(std::string warning) {
    if (kept_.size() < kMax)
      kept_.push_back(std::move(warning));
    else
      ++left_out_;
  }
  /// Returns whether kMax warnings are kept, so that add() only counts.
  bool is_full() const { return kept_.size() >= kMax; }

  /// Returns the warnings. If some were left out, the last one says how many.
  std::vector<std::string> take(const std::string& file) {
    if (left_out_ > 0)
      kept_.push_back(file + ": " + std::to_string(left_out_) + " more warnings are not shown");
    left_out_ = 0;
    return std::exchange(kept_, {});
  }

 private:
  std::vector<std::string> kept_;
  std::size_t left_out_ = 0;
};

}  // namespace voxdag
