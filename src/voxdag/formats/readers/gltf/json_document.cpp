#include "voxdag/formats/readers/gltf/json_document.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>

#include "voxdag/core/utf8.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the value of four hexadecimal digits, or -1.
int parse_hex4(std::string_view text) {
  if (text.size() < 4) return -1;
  int value = 0;
  for (const char c : text.substr(0, 4)) {
    const int digit = is_digit(c)              ? c - '0'
                      : (c >= 'a' && c <= 'f') ? c - 'a' + 10
                      : (c >= 'A' && c <= 'F') ? c - 'A' + 10
                                               : -1;
    if (digit < 0) return -1;
    value = value * 16 + digit;
  }
  return value;
}

bool is_high_surrogate(int code) { return code >= 0xD800 && code < 0xDC00; }
bool is_low_surrogate(int code) { return code >= 0xDC00 && code < 0xE000; }

/// Returns the bytes of the escape sequence that the text starts with, or 0 if it is malformed.
std::size_t escape_bytes(std::string_view text) {
  if (text.size() < 2) return 0;
  if (text[1] != 'u') return std::string_view("\"\\/bfnrt").find(text[1]) == text.npos ? 0 : 2;
  const int code = parse_hex4(text.substr(2));
  if (code < 0 || is_low_surrogate(code)) return 0;
  if (!is_high_surrogate(code)) return 6;
  const std::string_view second = text.substr(6);
  return second.starts_with("\\u") && is_low_surrogate(parse_hex4(second.substr(2))) ? 12 : 0;
}

void append_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

}  // namespace

std::string unescape_json(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '\\') {
      out += text[i++];
      continue;
    }
    const std::size_t bytes = escape_bytes(text.substr(i));
    const char kind = text[i + 1];
    if (kind == 'u') {
      auto code = static_cast<std::uint32_t>(parse_hex4(text.substr(i + 2)));
      if (bytes == 12) {
        const auto low = static_cast<std::uint32_t>(parse_hex4(text.substr(i + 8)));
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
      }
      append_utf8(out, code);
    } else {
      out += kind == 'b'   ? '\b'
             : kind == 'f' ? '\f'
             : kind == 'n' ? '\n'
             : kind == 'r' ? '\r'
             : kind == 't' ? '\t'
                           : kind;
    }
    i += bytes;
  }
  return out;
}

/// Parses without recursion: the children of an open container wait in `pending_` until it closes.
class JsonDocument::Parser {
 public:
  Parser(const MeshSource& source, JsonDocument& document)
      : source_(source),
        document_(document),
        text_(document.text_),
        poll_(source.work()),
        pending_(source.work().memory),
        open_(source.work().memory) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  void parse() {
    for (;;) {
      JsonNode node = begin_value();
      const bool is_object = node.kind == JsonKind::kObject;
      if (is_object || node.kind == JsonKind::kArray) {
        open_.push_back({node, pending_.size()});
        skip_space();
        if (!take(is_object ? '}' : ']')) {
          if (is_object) read_key();
          continue;
        }
        node = close();
      }
      if (end_value(node)) return;
    }
  }

 private:
  struct Container {
    JsonNode node;
    std::size_t first_pending;
  };

  [[noreturn]] void fail(std::size_t at, const char* reason = "the JSON is malformed here") const {
    const auto start = static_cast<std::size_t>(text_.data() - source_.bytes.data());
    throw source_.error_at_byte(start + at, std::string("not glTF: ") + reason);
  }

  void skip_space() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) {
      ++at_;
      poll_.step();
    }
  }
  bool take(char c) {
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    skip_space();
    if (!take(c)) fail(at_);
  }

  /// Reads the start of a value: a complete scalar, or the opening bracket of a container.
  JsonNode begin_value() {
    poll_.step();
    skip_space();
    JsonNode node = key_;
    key_ = {};
    if (at_ == text_.size()) fail(at_);
    switch (text_[at_]) {
      case '{':
      case '[':
        node.kind = text_[at_++] == '{' ? JsonKind::kObject : JsonKind::kArray;
        return node;
      case '"':
        node.kind = JsonKind::kString;
        read_string(node.start, node.size);
        return node;
      case 't':
        return word(node, "true", JsonKind::kTrue);
      case 'f':
        return word(node, "false", JsonKind::kFalse);
      case 'n':
        return word(node, "null", JsonKind::kNull);
      default:
        return number(node);
    }
  }

  JsonNode word(JsonNode node, std::string_view name, JsonKind kind) {
    if (!text_.substr(at_).starts_with(name)) fail(at_);
    at_ += name.size();
    node.kind = kind;
    return node;
  }

  JsonNode number(JsonNode node) {
    const std::size_t start = at_;
    const auto digits = [&] {
      const std::size_t first = at_;
      for (; at_ < text_.size() && is_digit(text_[at_]); ++at_) poll_.step();
      if (at_ == first) fail(at_);
    };
    take('-');
    if (!take('0')) digits();
    if (take('.')) digits();
    if (take('e') || take('E')) {
      if (!take('+')) take('-');
      digits();
    }
    double value = 0;
    fast_float::from_chars(text_.data() + start, text_.data() + at_, value);
    if (std::isinf(value)) fail(start, "the JSON has a number out of range");
    node.kind = JsonKind::kNumber;
    node.start = static_cast<std::uint32_t>(start);
    node.size = static_cast<std::uint32_t>(at_ - start);
    return node;
  }

  /// Reads a string and sets the position of the text between its quotes. Returns whether it has
  /// escape sequences.
  bool read_string(std::uint32_t& start, std::uint32_t& size) {
    ++at_;
    start = static_cast<std::uint32_t>(at_);
    bool has_escapes = false;
    for (;;) {
      poll_.step();
      if (at_ == text_.size()) fail(at_);
      const char c = text_[at_];
      if (c == '"') break;
      std::size_t bytes = 1;
      if (c == '\\') {
        bytes = escape_bytes(text_.substr(at_, 12));
        has_escapes = true;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        bytes = 0;
      } else if (static_cast<unsigned char>(c) >= 0x80) {
        bytes = utf8_character_bytes(text_.substr(at_));
      }
      if (bytes == 0) fail(at_);
      at_ += bytes;
    }
    size = static_cast<std::uint32_t>(at_ - start);
    ++at_;
    return has_escapes;
  }

  void read_key() {
    skip_space();
    if (at_ == text_.size() || text_[at_] != '"') fail(at_);
    key_ = {};
    if (read_string(key_.key_start, key_.key_size)) {
      const std::string key = unescape_json(text_.substr(key_.key_start, key_.key_size));
      CountedVector<char>& keys = document_.unescaped_keys_;
      key_.key_start = static_cast<std::uint32_t>(keys.size());
      key_.key_size = static_cast<std::uint32_t>(key.size());
      key_.has_unescaped_key = true;
      keys.insert(keys.end(), key.begin(), key.end());
    }
    expect(':');
  }

  /// Adds a complete value to its container. Reads commas and closing brackets until another value
  /// begins. Returns whether the document is complete.
  bool end_value(JsonNode node) {
    for (;;) {
      skip_space();
      if (open_.empty()) {
        if (at_ != text_.size()) fail(at_);
        place(node, document_.nodes_);
        return true;
      }
      pending_.push_back(node);
      const bool in_object = open_.back().node.kind == JsonKind::kObject;
      if (take(',')) {
        if (in_object) read_key();
        return false;
      }
      if (!take(in_object ? '}' : ']')) fail(at_);
      node = close();
    }
  }

  /// Moves the children of the last container into the document and returns the container.
  JsonNode close() {
    const Container container = open_.back();
    open_.pop_back();
    JsonNode node = container.node;
    const auto first = pending_.begin() + static_cast<std::ptrdiff_t>(container.first_pending);
    if (node.kind == JsonKind::kObject) sort_members(first);
    CountedVector<JsonNode>& nodes = document_.nodes_;
    node.first = static_cast<std::uint32_t>(nodes.size());
    node.count = static_cast<std::uint32_t>(pending_.end() - first);
    for (auto child = first; child != pending_.end(); ++child) place(*child, nodes);
    pending_.erase(first, pending_.end());
    return node;
  }

  /// Gives a complete value its place in the document.
  static void place(const JsonNode& node, CountedVector<JsonNode>& nodes) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(node);
    for (std::uint32_t i = 0; i < node.count; ++i) nodes[node.first + i].parent = index;
  }

  /// Sorts the pending values from `first` on by key, and keeps the last one of each key.
  void sort_members(CountedVector<JsonNode>::iterator first) {
    const auto key = [&](const JsonNode& node) { return document_.key(node); };
    const auto members = static_cast<std::uint64_t>(pending_.end() - first);
    const MemoryReservation scratch(source_.work().memory, members * sizeof(JsonNode));
    std::stable_sort(first, pending_.end(),
                     [&](const JsonNode& a, const JsonNode& b) { return key(a) < key(b); });
    auto out = first;
    for (auto member = first; member != pending_.end(); ++member) {
      if (out != first && key(*(out - 1)) == key(*member)) --out;
      *out++ = *member;
    }
    pending_.erase(out, pending_.end());
  }

  const MeshSource& source_;
  JsonDocument& document_;
  const std::string_view text_;
  CancelPoll poll_;
  std::size_t at_ = 0;
  JsonNode key_;                     ///< In an object: the key of the next value.
  CountedVector<JsonNode> pending_;  ///< Complete values of open containers.
  CountedVector<Container> open_;
};

JsonDocument::JsonDocument(const MeshSource& source, std::string_view text)
    : text_(text), nodes_(source.work().memory), unescaped_keys_(source.work().memory) {
  if (text.size() >= kAbsent) throw source.error("the JSON must be smaller than 4 GiB");
  Parser(source, *this).parse();
}

std::string_view JsonDocument::key(const JsonNode& node) const {
  if (node.has_unescaped_key) return {unescaped_keys_.data() + node.key_start, node.key_size};
  return text_.substr(node.key_start, node.key_size);
}

std::uint32_t JsonDocument::member(const JsonNode& object, std::string_view key) const {
  const auto first = nodes_.begin() + object.first, last = first + object.count;
  const auto found = std::lower_bound(
      first, last, key,
      [&](const JsonNode& node, std::string_view wanted) { return this->key(node) < wanted; });
  const bool exists = found != last && this->key(*found) == key;
  return exists ? static_cast<std::uint32_t>(found - nodes_.begin()) : kAbsent;
}

std::string JsonDocument::path(std::uint32_t index) const {
  if (index == root()) return "";
  const JsonNode& value = node(index);
  const std::string before = path(value.parent);
  const JsonNode& parent = node(value.parent);
  if (parent.kind == JsonKind::kArray)
    return before + "[" + std::to_string(index - parent.first) + "]";
  return before.empty() ? printable(key(value)) : before + "." + printable(key(value));
}

}  // namespace voxdag
