#pragma once
/// The place of an error in a file.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace voxdag {

/// A path of steps into a file, outermost first: "byte 84", "line 12", "chunk NODE, level 3, word
/// 17". An empty place means the file as a whole. Code that must know the place calls has(); text()
/// is for people.
class ErrorPlace {
 public:
  enum class Kind : std::uint8_t {
    kNamed,  ///< A part or member with a name of its own: "header", "counts.voxels".
    kByte,
    kLine,
    kChunk,  ///< Named by the four letters of its id.
    kLevelTable,
    kLevel,
    kWord,
    kLeafBlock,
    kBlock,
    kSlot,
  };

  ErrorPlace() = default;
  ErrorPlace(std::string name) {  // NOLINT(google-explicit-constructor): places are often names
    if (!name.empty()) steps_.push_back({Kind::kNamed, std::move(name)});
  }
  ErrorPlace(const char* name)  // NOLINT(google-explicit-constructor)
      : ErrorPlace(std::string(name)) {}

  static ErrorPlace byte(std::uint64_t offset) { return numbered(Kind::kByte, "byte", offset); }
  /// Returns the place of a line; `number` counts from 1.
  static ErrorPlace line(std::uint64_t number) { return numbered(Kind::kLine, "line", number); }
  static ErrorPlace chunk(const std::string& id) { return {Kind::kChunk, "chunk " + id}; }
  static ErrorPlace level_table() { return {Kind::kLevelTable, "level table"}; }
  static ErrorPlace level(int level) {
    return numbered(Kind::kLevel, "level", static_cast<std::uint64_t>(level));
  }
  static ErrorPlace word(std::uint64_t index) { return numbered(Kind::kWord, "word", index); }
  static ErrorPlace leaf_block(std::uint64_t index) {
    return numbered(Kind::kLeafBlock, "leaf block", index);
  }
  static ErrorPlace block(std::uint64_t index) { return numbered(Kind::kBlock, "block", index); }
  static ErrorPlace slot(std::uint64_t index) { return numbered(Kind::kSlot, "slot", index); }

  /// Returns the place `inner` within this one.
  friend ErrorPlace operator/(ErrorPlace outer, const ErrorPlace& inner) {
    outer.steps_.insert(outer.steps_.end(), inner.steps_.begin(), inner.steps_.end());
    return outer;
  }

  bool empty() const { return steps_.empty(); }
  /// Returns whether the path has a step of this kind.
  bool has(Kind kind) const {
    for (const Step& step : steps_)
      if (step.kind == kind) return true;
    return false;
  }
  /// Returns the steps, separated by commas.
  std::string text() const {
    std::string text;
    for (const Step& step : steps_) text += (text.empty() ? "" : ", ") + step.text;
    return text;
  }

 private:
  struct Step {
    Kind kind;
    std::string text;
  };

  ErrorPlace(Kind kind, std::string text) { steps_.push_back({kind, std::move(text)}); }
  static ErrorPlace numbered(Kind kind, const char* what, std::uint64_t number) {
    return {kind, std::string(what) + " " + std::to_string(number)};
  }

  std::vector<Step> steps_;
};

}  // namespace voxdag
