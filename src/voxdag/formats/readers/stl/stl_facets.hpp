#pragma once
/// The facets of binary STL files, and the grammar of ascii ones. Parses any part of a file that
/// starts and ends between facets.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

inline constexpr std::size_t kStlHeaderBytes = 84, kStlFacetBytes = 50;
inline constexpr std::size_t kMaxStlFacets = 0xFFFFFFFF / 3;

inline std::uint32_t load_stl_word(const char* p) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(p[i])} << 8 * i;
  return word;
}

/// Returns the number of facets in the header of a file.
inline std::uint32_t stl_facet_count(std::string_view bytes) {
  return load_stl_word(bytes.data() + 80);
}

/// Calls body(Vec3f) for each corner of a run of facets.
template <class Body>
void parse_stl_binary(const MeshSource& source, std::string_view facets, const Body& body) {
  for (std::size_t facet = 0; facet < facets.size(); facet += kStlFacetBytes)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* p = facets.data() + facet + 12 * (corner + 1);
      const Vec3f position{std::bit_cast<float>(load_stl_word(p)),
                           std::bit_cast<float>(load_stl_word(p + 4)),
                           std::bit_cast<float>(load_stl_word(p + 8))};
      body(source.vertex(static_cast<Vec3d>(position)));
    }
}

/// Returns whether `token` is `word`, ignoring the case of ASCII letters. `word` is in lower case.
inline bool same_word(std::string_view token, std::string_view word) {
  return std::equal(token.begin(), token.end(), word.begin(), word.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + 32) : a) == b;
  });
}

/// The words of a text; lines do not matter.
class StlTokens {
 public:
  explicit StlTokens(std::string_view text) : p_(text.data()), end_(p_ + text.size()) {}

  /// Returns the next word; empty at the end.
  std::string_view next() {
    skip_space();
    const char* const first = p_;
    while (p_ != end_ && !is_space(*p_)) ++p_;
    return {first, static_cast<std::size_t>(p_ - first)};
  }
  /// Skips the next word if it is `word`, which is in lower case. Returns whether it is.
  bool take(std::string_view word) {
    skip_space();
    if (static_cast<std::size_t>(end_ - p_) < word.size() || !same_word({p_, word.size()}, word) ||
        (p_ + word.size() != end_ && !is_space(p_[word.size()])))
      return false;
    p_ += word.size();
    return true;
  }
  /// Skips the next word if it is a number and sets `value` as parse_coordinate() does. Returns
  /// whether it is.
  bool take_coordinate(double origin, float& value) {
    skip_space();
    const auto result = parse_coordinate_prefix(p_, end_, origin, value);
    if (result == nullptr || (result != end_ && !is_space(*result))) return false;
    p_ = result;
    return true;
  }
  /// Skips the name of a solid: the rest of the line, or its part before a facet.
  void skip_name() {
    while (p_ != end_ && *p_ != '\n' && *p_ != '\r') {
      if (is_space(*p_))
        ++p_;
      else if (starts_facet())
        return;
      else
        next();
    }
  }

 private:
  /// Returns whether "facet outer" or "facet normal" and a number follow.
  bool starts_facet() const {
    StlTokens ahead = *this;
    float ignored = 0;
    return ahead.take("facet") &&
           (ahead.take("outer") || (ahead.take("normal") && ahead.take_coordinate(0, ignored)));
  }
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void skip_space() {
    while (p_ != end_ && is_space(*p_)) ++p_;
  }

  const char* p_;
  const char* end_;
};

/// Splits a file after words "endfacet" into parts of about `chunk_bytes`.
inline std::vector<std::string_view> split_facets(std::string_view text, std::size_t chunk_bytes) {
  constexpr std::string_view kWord = "endfacet";
  std::vector<std::string_view> parts;
  parts.reserve(text.size() / chunk_bytes + 1);
  std::size_t start = 0;
  for (std::size_t cut = chunk_bytes; cut + kWord.size() < text.size(); ++cut)
    if (same_word(text.substr(cut, kWord.size()), kWord)) {
      cut += kWord.size();
      parts.push_back(text.substr(start, cut - start));
      start = cut;
      cut += chunk_bytes;
    }
  parts.push_back(text.substr(start));
  return parts;
}

/// Calls body(Vec3f) for each corner of a part from split_facets(). Returns how many words "solid"
/// and "endsolid" are missing or doubled, how many words such as "end loop" are split, and how many
/// facets have no normal or no numbers of it. Throws Fault for text that breaks the grammar
/// otherwise.
template <class Body>
std::size_t parse_stl_text(const MeshSource& source, std::string_view part, bool is_first,
                           bool is_last, const Body& body) {
  StlTokens tokens(is_first ? without_byte_order_mark(part) : part);
  std::size_t irregular = 0;
  const auto expect = [&](std::string_view word) {
    if (tokens.take(word)) return;
    const std::string_view token = tokens.next();
    if (token.empty()) throw Fault{token.data(), "the file ends inside a facet"};
    throw Fault{token.data(), "expected '" + std::string(word) + "', not " + in_quotes(token)};
  };
  const auto expect_end = [&](std::string_view word) {
    if (!tokens.take("end")) return expect(word);
    ++irregular;
    expect(word.substr(3));
  };
  const auto coordinate = [&](int axis) {
    float value = 0;
    if (tokens.take_coordinate(source.origin[axis], value)) return value;
    const std::string_view token = tokens.next();
    if (token.empty()) throw Fault{token.data(), "the file ends inside a facet"};
    throw Fault{token.data(), "coordinate " + in_quotes(token) + " is not a number"};
  };

  bool in_solid = !is_first;
  for (;;) {
    const std::string_view token = tokens.next();
    const bool is_split_end = same_word(token, "end") && tokens.take("solid");
    if (token.empty()) return irregular + (is_last && in_solid ? 1 : 0);
    if (same_word(token, "facet")) {
      irregular += in_solid ? 0 : 1;
      in_solid = true;
      const bool has_normal = !tokens.take("outer");
      if (has_normal) expect("normal");
      if (!has_normal || tokens.take("outer")) {
        ++irregular;
      } else {
        for (int i = 0; i < 3; ++i) {  // The normal is unused: some writers put NaN there.
          if (tokens.next().empty()) throw Fault{token.data(), "the file ends inside a facet"};
        }
        expect("outer");
      }
      expect("loop");
      for (int corner = 0; corner < 3; ++corner) {
        expect("vertex");
        const float x = coordinate(0), y = coordinate(1), z = coordinate(2);
        body(Vec3f{x, y, z});
      }
      expect_end("endloop");
      expect_end("endfacet");
    } else if (is_split_end || same_word(token, "endsolid") || same_word(token, "solid")) {
      const bool starts = !is_split_end && same_word(token, "solid");
      irregular += (starts == in_solid ? 1 : 0) + (is_split_end ? 1 : 0);
      in_solid = starts;
      tokens.skip_name();
    } else {
      throw Fault{token.data(), std::string("expected ") +
                                    (in_solid ? "'facet' or 'endsolid'" : "'solid'") + ", not " +
                                    in_quotes(token)};
    }
  }
}

}  // namespace voxdag
